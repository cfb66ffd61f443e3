#include "explain/math_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace lambent {
namespace {

using Kind = MathTerm::Kind;
using Nodes = std::array<int, color_channels>;

bool is_grey(const Rgb& c) { return c[0] == c[1] && c[0] == c[2]; }

class Simplifier {
 public:
  explicit Simplifier(const Formulas& formulas) : formulas_(formulas) {}

  MathTerm operator()(const Nodes& nodes) const {
    MathTerm term;
    for (int c = 0; c < color_channels; ++c) term.value[c] = at(nodes, c).value;
    const FormulaNode& first = at(nodes, 0);
    for (int c = 1; c < color_channels; ++c)
      if (at(nodes, c).operation != first.operation) return term;
    switch (first.operation) {
      case Operation::number:
        return term;
      case Operation::symbol:
        term.kind = Kind::symbol;
        term.name = first.name;
        return term;
      case Operation::negate:
        return made(term, Kind::negative, {a(nodes)});
      case Operation::absolute:
        return made(term, Kind::absolute, {a(nodes)});
      case Operation::root:
        return made(term, Kind::root, {a(nodes)});
      case Operation::power:
        return made(term, Kind::power, {a(nodes), b(nodes)});
      case Operation::add:
        return sum(term, a(nodes), b(nodes));
      case Operation::subtract: {
        MathTerm minuend = a(nodes), subtrahend = b(nodes);
        if (is_constant(subtrahend, 0)) return minuend;
        return made(term, Kind::difference, {std::move(minuend), std::move(subtrahend)});
      }
      case Operation::multiply:
        return product(term, a(nodes), b(nodes));
      case Operation::divide: {
        MathTerm above = a(nodes), below = b(nodes);
        if (is_constant(below, 1)) return above;
        return made(term, Kind::quotient, {std::move(above), std::move(below)});
      }
      case Operation::max:
      case Operation::min: {
        MathTerm x = a(nodes), y = b(nodes);
        if (first.operation == Operation::max && is_constant(y, 0))
          return made(term, Kind::positive_part, {std::move(x)});
        if (first.operation == Operation::max && is_constant(x, 0))
          return made(term, Kind::positive_part, {std::move(y)});
        if (x.value == term.value) return x;
        return y.value == term.value ? y : term;
      }
      case Operation::choose: {
        for (int c = 1; c < color_channels; ++c)
          if (at(nodes, c).first != first.first) return term;
        return first.first ? a(nodes) : b(nodes);
      }
    }
    return term;
  }

 private:
  const FormulaNode& at(const Nodes& nodes, int c) const {
    return formulas_.nodes[std::size_t(nodes[std::size_t(c)])];
  }
  MathTerm a(const Nodes& nodes) const {
    Nodes parts{};
    for (int c = 0; c < color_channels; ++c) parts[std::size_t(c)] = at(nodes, c).a;
    return (*this)(parts);
  }
  MathTerm b(const Nodes& nodes) const {
    Nodes parts{};
    for (int c = 0; c < color_channels; ++c) parts[std::size_t(c)] = at(nodes, c).b;
    return (*this)(parts);
  }
  static bool is_constant(const MathTerm& term, double value) {
    return term.kind == Kind::number && term.value == grey(value);
  }
  static MathTerm made(MathTerm term, Kind kind, std::vector<MathTerm> parts) {
    term.kind = kind;
    term.parts = std::move(parts);
    return term;
  }
  static MathTerm sum(MathTerm term, MathTerm x, MathTerm y) {
    if (is_constant(x, 0)) return y;
    if (is_constant(y, 0)) return x;
    return made(std::move(term), Kind::sum, {std::move(x), std::move(y)});
  }
  static MathTerm product(MathTerm term, MathTerm x, MathTerm y) {
    if (is_constant(x, 0) || is_constant(y, 0)) return term;
    if (is_constant(x, 1)) return y;
    if (is_constant(y, 1)) return x;
    // x (a / b) reads better as x a / b.
    for (const bool first : {true, false}) {
      MathTerm &quotient = first ? x : y, &other = first ? y : x;
      if (quotient.kind != Kind::quotient) continue;
      MathTerm above = quotient.parts[0], below = quotient.parts[1];
      MathTerm numerator;
      for (int c = 0; c < color_channels; ++c) numerator.value[c] = above.value[c] * other.value[c];
      numerator = first ? product(numerator, std::move(above), std::move(other))
                        : product(numerator, std::move(other), std::move(above));
      return made(std::move(term), Kind::quotient, {std::move(numerator), std::move(below)});
    }
    if (x.kind == Kind::symbol && y.kind == Kind::symbol && x.name == y.name) {
      MathTerm two;
      two.value = grey(2.0);
      return made(std::move(term), Kind::power, {std::move(x), std::move(two)});
    }
    return made(std::move(term), Kind::product, {std::move(x), std::move(y)});
  }

  const Formulas& formulas_;
};

int precedence(const MathTerm& term) {
  switch (term.kind) {
    case Kind::sum:
    case Kind::difference:
    case Kind::negative:
      return 1;
    case Kind::product:
    case Kind::quotient:
      return 2;
    case Kind::power:
      return 3;
    default:
      return 4;
  }
}

/// A plain formula in pieces: words, and what stands between them.
std::vector<std::string> pieces_of(const std::string& plain) {
  std::vector<std::string> pieces;
  for (std::size_t i = 0; i < plain.size();) {
    const auto is_word = [&](std::size_t at) {
      return at < plain.size() && (std::isalnum(static_cast<unsigned char>(plain[at])) || plain[at] == '_');
    };
    std::size_t end = i + 1;
    if (is_word(i))
      while (is_word(end)) ++end;
    pieces.push_back(plain.substr(i, end - i));
    i = end;
  }
  return pieces;
}

/// "Kd" is K with an index d; "shininess" is a word.
bool has_index(const std::string& word) {
  return word.size() == 2 && std::isupper(static_cast<unsigned char>(word[0])) &&
         std::islower(static_cast<unsigned char>(word[1]));
}

std::string latex_plain(const std::string& plain) {
  std::string result;
  for (const std::string& piece : pieces_of(plain)) {
    if (piece == ".") result += "\\cdot ";
    else if (piece == "|") result += "|";
    else if (has_index(piece)) result += fmt::format("{}_{}", piece[0], piece[1]);
    else if (piece.size() > 1 && !std::isdigit(static_cast<unsigned char>(piece[0]))) {
      result += "\\mathrm{";
      for (const char c : piece) result += c == '_' ? "\\_" : std::string(1, c);
      result += "}";
    } else result += piece;
  }
  return result;
}

std::string mathml_plain(const std::string& plain) {
  std::string result;
  for (const std::string& piece : pieces_of(plain)) {
    if (piece == " ") continue;
    if (piece == ".") result += "<mo>&#8901;</mo>";
    else if (has_index(piece))
      result += fmt::format("<msub><mi>{}</mi><mi>{}</mi></msub>", piece[0], piece[1]);
    else if (std::isdigit(static_cast<unsigned char>(piece[0]))) result += "<mn>" + piece + "</mn>";
    else if (std::isalpha(static_cast<unsigned char>(piece[0]))) result += "<mi>" + piece + "</mi>";
    else result += "<mo>" + std::string(piece == "<" ? "&lt;" : piece == "&" ? "&amp;" : piece) + "</mo>";
  }
  return "<mrow>" + result + "</mrow>";
}

/// A number with its exponent as the notation wants it.
std::string number_in(double value, Notation notation) {
  const std::string text = short_number(value);
  const std::size_t e = text.find('e');
  if (notation == Notation::text || e == std::string::npos) {
    if (notation != Notation::mathml) return text;
    return text[0] == '-' ? "<mrow><mo>-</mo><mn>" + text.substr(1) + "</mn></mrow>"
                          : "<mn>" + text + "</mn>";
  }
  const std::string mantissa = text.substr(0, e);
  const int exponent = std::stoi(text.substr(e + 1));
  if (notation == Notation::latex) return fmt::format("{}\\cdot 10^{{{}}}", mantissa, exponent);
  return fmt::format("<mrow><mn>{}</mn><mo>&#8901;</mo><msup><mn>10</mn><mn>{}</mn></msup></mrow>", mantissa,
                     exponent);
}

class Writer {
 public:
  Writer(Notation notation, Filled filled) : notation_(notation), filled_(filled) {}

  std::string operator()(const MathTerm& term) const {
    const auto& parts = term.parts;
    const bool numbers = filled_ == Filled::numbers;
    switch (term.kind) {
      case Kind::number:
        return written(term.value, notation_);
      case Kind::symbol:
        return numbers ? written(term.value, notation_) : written(term.name, notation_);
      case Kind::sum:
        return row((*this)(parts[0]) + sign(" + ", "<mo>+</mo>") + (*this)(parts[1]));
      case Kind::difference:
        return row((*this)(parts[0]) + sign(" - ", "<mo>-</mo>") + held(parts[1], 2));
      case Kind::product: {
        const std::string between = !numbers                       ? sign(" ", "<mo>&#8290;</mo>")
                                    : notation_ == Notation::latex ? " \\cdot "
                                                                   : sign(" * ", "<mo>&#8901;</mo>");
        return row(held(parts[0], 2) + between + held(parts[1], 2));
      }
      case Kind::quotient:
        if (notation_ == Notation::latex)
          return "\\frac{" + (*this)(parts[0]) + "}{" + (*this)(parts[1]) + "}";
        if (notation_ == Notation::mathml)
          return "<mfrac>" + row((*this)(parts[0])) + row((*this)(parts[1])) + "</mfrac>";
        return held(parts[0], 2) + " / " + held(parts[1], 3);
      case Kind::power:
        if (notation_ == Notation::latex) return "{" + held(parts[0], 4) + "}^{" + (*this)(parts[1]) + "}";
        if (notation_ == Notation::mathml)
          return "<msup>" + row(held(parts[0], 4)) + row((*this)(parts[1])) + "</msup>";
        return held(parts[0], 4) + "^" + held(parts[1], 4);
      case Kind::positive_part:
        if (numbers && parts[0].value == term.value) return held(parts[0], 4);
        if (notation_ == Notation::latex) return "\\left(" + (*this)(parts[0]) + "\\right)^{+}";
        if (notation_ == Notation::mathml)
          return "<msup><mrow><mo>(</mo>" + (*this)(parts[0]) + "<mo>)</mo></mrow><mo>+</mo></msup>";
        return "(" + (*this)(parts[0]) + ")+";
      case Kind::root:
        if (notation_ == Notation::latex) return "\\sqrt{" + (*this)(parts[0]) + "}";
        if (notation_ == Notation::mathml) return "<msqrt>" + (*this)(parts[0]) + "</msqrt>";
        return "sqrt(" + (*this)(parts[0]) + ")";
      case Kind::negative:
        return row(sign("-", "<mo>-</mo>") + held(parts[0], 2));
      case Kind::absolute:
        return row(sign("|", "<mo>|</mo>") + (*this)(parts[0]) + sign("|", "<mo>|</mo>"));
    }
    return "";
  }

 private:
  std::string sign(const char* plain, const char* mathml) const {
    return notation_ == Notation::mathml ? mathml : plain;
  }
  std::string row(std::string text) const {
    return notation_ == Notation::mathml ? "<mrow>" + text + "</mrow>" : text;
  }
  /// In brackets where it would fall apart next to what binds as tightly as `tight`; negative numbers too.
  std::string held(const MathTerm& part, int tight) const {
    std::string text = (*this)(part);
    const bool as_number =
        part.kind == Kind::number || (part.kind == Kind::symbol && filled_ == Filled::numbers);
    const bool loose = as_number ? is_grey(part.value) && (part.value[0] < 0) : precedence(part) < tight;
    if (!loose) return text;
    if (notation_ == Notation::latex) return "\\left(" + text + "\\right)";
    if (notation_ == Notation::mathml) return "<mrow><mo>(</mo>" + text + "<mo>)</mo></mrow>";
    return "(" + text + ")";
  }

  Notation notation_;
  Filled filled_;
};

}  // namespace

MathTerm simplified(const Formulas& formulas, const Color<Traced>& c) {
  Nodes nodes{};
  for (int i = 0; i < color_channels; ++i) nodes[std::size_t(i)] = c[i].node;
  return Simplifier(formulas)(nodes);
}
MathTerm simplified(const Formulas& formulas, const Traced& number) {
  Nodes nodes{};
  nodes.fill(number.node);
  return Simplifier(formulas)(nodes);
}

std::vector<const MathTerm*> symbols_of(const MathTerm& term) {
  std::vector<const MathTerm*> result;
  const auto collect = [&](const auto& self, const MathTerm& one) -> void {
    if (one.kind == Kind::symbol && std::none_of(result.begin(), result.end(), [&](const MathTerm* known) {
          return known->name == one.name;
        }))
      result.push_back(&one);
    for (const MathTerm& part : one.parts) self(self, part);
  };
  collect(collect, term);
  return result;
}

std::string written(const MathTerm& term, Notation notation, Filled filled) {
  return Writer(notation, filled)(term);
}

std::string written(const std::string& plain, Notation notation) {
  return notation == Notation::latex    ? latex_plain(plain)
         : notation == Notation::mathml ? mathml_plain(plain)
                                        : plain;
}

std::string short_number(double value) {
  if (std::isinf(value)) return value > 0 ? "infinity" : "-infinity";
  std::string text = fmt::format("{:.4g}", value);
  return text == "-0" ? "0" : text;
}

std::string short_color(const Rgb& color) {
  if (is_grey(color)) return short_number(color[0]);
  std::string text;
  for (int c = 0; c < color_channels; ++c) text += (c ? " " : "") + short_number(color[c]);
  return text;
}

std::string written(const Rgb& color, Notation notation) {
  if (is_grey(color)) return number_in(color[0], notation);
  std::string text;
  for (int c = 0; c < color_channels; ++c) {
    if (notation == Notation::mathml) text += "<mtd>" + number_in(color[c], notation) + "</mtd>";
    else text += (c == 0 ? "" : notation == Notation::latex ? " & " : " ") + number_in(color[c], notation);
  }
  if (notation == Notation::latex) return "\\begin{pmatrix}" + text + "\\end{pmatrix}";
  if (notation == Notation::mathml)
    return "<mrow><mo>(</mo><mtable><mtr>" + text + "</mtr></mtable><mo>)</mo></mrow>";
  return "(" + text + ")";
}

}  // namespace lambent
