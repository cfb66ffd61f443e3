#include "scenefile/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "import/text_file.h"
#include "lambent/image.h"
#include "scenefile/nearest.h"

namespace lambent {
namespace {

/// More than this many remarks help nobody, and a damaged file of a million numbers would make as many.
constexpr std::size_t most_errors = 1000;

constexpr const char* decimals = "numbers are written in decimals: 16, 0.5, -1e-3";

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Whether `text` is a decimal number: sign, digits, point, exponent. No hexadecimals, no underscores, no
/// words.
bool is_decimal(std::string_view text) {
  std::size_t i = 0;
  const auto digits = [&] {
    const std::size_t start = i;
    while (i < text.size() && is_digit(text[i])) ++i;
    return i > start;
  };
  if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
  bool any = digits();
  if (i < text.size() && text[i] == '.') {
    ++i;
    any = digits() || any;
  }
  if (!any) return false;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    ++i;
    if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
    if (!digits()) return false;
  }
  return i == text.size();
}

/// NaN and infinity, as YAML, JSON's relatives and C write them.
bool is_not_finite(std::string_view text) {
  std::string word;
  for (const char c : text)
    if (c != '.' && c != '+' && c != '-') word += char(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return word == "nan" || word == "inf" || word == "infinity";
}

/// The value, cut to what fits in a message.
std::string in_quotes(const std::string& text) {
  constexpr std::size_t longest = 40;
  std::string shown;
  for (const char c : text) {
    if (shown.size() >= longest) {
      shown += "...";
      break;
    }
    shown += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return "'" + shown + "'";
}

std::string power_of_ten(double value) { return fmt::format("1e{}", std::lround(std::log10(value))); }

std::string describe(const Node& node) {
  switch (node.kind) {
    case Node::Kind::nothing:
      return "nothing";
    case Node::Kind::list:
      return "a list";
    case Node::Kind::mapping:
      return "a mapping";
    case Node::Kind::text:
      return in_quotes(node.text);
  }
  __builtin_unreachable();
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

const Value* Values::find(std::string_view key) const {
  for (const Value& value : values)
    if (value.key->text == key) return &value;
  return nullptr;
}

void Reader::error(const Node& at, std::string message, std::string hint) {
  error(at, diagnostic_at(document_, at, std::move(message), std::move(hint)));
}

void Reader::error(const Node& at, Diagnostic diagnostic) {
  if (found_.size() >= most_errors) return;
  // A value shown twice by an alias is wrong once.
  for (const Found& other : found_)
    if (other.source == at.source && other.line == at.line && other.column == at.column &&
        other.diagnostic.message == diagnostic.message)
      return;
  found_.push_back({at.source, at.line, at.column, std::move(diagnostic)});
}

std::vector<Diagnostic> Reader::errors() const {
  std::vector<Found> sorted = found_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Found& a, const Found& b) {
    return std::tie(a.source, a.line, a.column) < std::tie(b.source, b.line, b.column);
  });
  std::vector<Diagnostic> result;
  for (Found& found : sorted) result.push_back(std::move(found.diagnostic));
  return result;
}

bool Reader::must_be(const Value& value, const std::string& what, std::string hint) {
  const Node& node = *value.node;
  if (!node.tag.empty()) {
    error(node, value.label + " has the tag " + in_quotes(node.tag), "remove it: scene files need no tags");
    return false;
  }
  if (node.kind == Node::Kind::nothing)
    error(value.place(), value.label + " has no value",
          hint.empty() ? "it must be " + what : std::move(hint));
  else error(node, value.label + " must be " + what + ", not " + describe(node), std::move(hint));
  return false;
}

std::optional<Values> Reader::mapping(const Value& value, const std::vector<Field>& fields,
                                      const std::string& what) {
  const Node& node = *value.node;
  const std::vector<std::string> known = names_of(fields);
  if (node.kind != Node::Kind::mapping || !node.tag.empty()) {
    must_be(value, "a mapping",
            node.kind == Node::Kind::text || known.empty() ? "" : "its keys are: " + join(known));
    return {};
  }
  Values result;
  result.whole = value;
  std::vector<std::string> guessed;  // known keys that unknown ones seem to mean
  for (std::size_t i = 0; i + 1 < node.children.size(); i += 2) {
    const Node& key = *node.children[i];
    if (key.kind != Node::Kind::text) {
      error(key, "a key must be text, not " + describe(key));
      result.unknown_keys = true;
      continue;
    }
    if (key.text == "<<" && !key.quoted) {
      error(key, "merging with '<<' is not part of the format",
            "write the keys out, or name the whole value with an alias");
      result.unknown_keys = true;
      continue;
    }
    if (const Value* first = result.find(key.text)) {
      const bool same_text = first->key->source == key.source && document_.sources[key.source].is_file;
      error(key, in_quotes(key.text) + " stands here a second time",
            same_text ? fmt::format("the first is in line {}; remove one of them", first->key->line)
                      : "remove one of them");
      continue;
    }
    if (std::find(known.begin(), known.end(), key.text) == known.end()) {
      result.unknown_keys = true;
      std::vector<std::string> missing;
      for (const std::string& name : known)
        if (value_of(node, name) == nullptr) missing.push_back(name);
      // Keys that are not there yet are the likelier ones to be meant.
      const std::string guess =
          !nearest(key.text, missing).empty() ? nearest(key.text, missing) : nearest(key.text, known);
      guessed.push_back(guess);
      std::string hint = suggestion(key.text, known);
      if (!guess.empty()) hint = "did you mean '" + guess + "'?";
      if (const std::size_t colon = key.text.find(':');
          colon != std::string::npos && node.children[i + 1]->kind == Node::Kind::nothing)
        hint = "a space belongs behind the colon: '" + key.text.substr(0, colon) + ": " +
               key.text.substr(colon + 1) + "'";
      error(key, "unknown key " + in_quotes(key.text) + " in " + what, std::move(hint));
      continue;
    }
    result.values.push_back({node.children[i + 1], &key, "'" + key.text + "'"});
  }
  for (const Field& field : fields) {
    if (!field.required || result.find(field.name) != nullptr) continue;
    // A misspelt key has been reported already; saying that it is missing as well would be noise.
    if (std::find(guessed.begin(), guessed.end(), field.name) != guessed.end()) continue;
    const Node& at = value.key != nullptr ? *value.key : node;
    error(at, what + " needs '" + field.name + "'",
          fmt::format("{} ({}{}): {}", field.name, type_name(field.type),
                      field.unit.empty() ? "" : ", " + field.unit, field.sentence));
  }
  return result;
}

std::optional<std::vector<Value>> Reader::list(const Value& value, const std::string& element) {
  const Node& node = *value.node;
  if (node.kind != Node::Kind::list || !node.tag.empty()) {
    must_be(value, "a list");
    return {};
  }
  std::vector<Value> result;
  result.reserve(node.children.size());
  for (std::size_t i = 0; i < node.children.size(); ++i)
    result.push_back({node.children[i], nullptr, fmt::format("{} {}", element, i + 1)});
  return result;
}

bool Reader::in_range(const Value& value, double number, const Range& range) {
  if (number >= range.min && number <= range.max) return true;
  std::string allowed = lambent::describe(range);
  // What people are told of a range leaves out the limits that hold for every number.
  if (number > range.max && range.max >= largest_coordinate) allowed = "at most " + power_of_ten(range.max);
  if (number < range.min && range.min <= -largest_coordinate)
    allowed = "at least -" + power_of_ten(-range.min);
  if (number > 0 && number < range.min) allowed = "at least " + text_of(range.min);
  error(*value.node, value.label + " is " + value.node->text + ", but must be " + allowed);
  return false;
}

bool Reader::number(const Value& value, const Range& range, double& out) {
  const Node& node = *value.node;
  if (node.kind != Node::Kind::text || !node.tag.empty()) return must_be(value, "a number");
  if (node.quoted) return must_be(value, "a number", is_decimal(node.text) ? "remove the quotes" : "");
  if (is_not_finite(node.text)) return must_be(value, "a finite number");
  if (!is_decimal(node.text)) return must_be(value, "a number", decimals);
  const std::optional<double> number = parse_number(node.text);
  if (!number) {
    error(node, value.label + " is " + in_quotes(node.text) + ", which is more than a number can hold");
    return false;
  }
  if (!in_range(value, *number, range)) return false;
  out = *number;
  return true;
}

bool Reader::integer(const Value& value, const Range& range, int& out) {
  const Node& node = *value.node;
  if (node.kind != Node::Kind::text || !node.tag.empty()) return must_be(value, "a whole number");
  // First the kind, then the range: 1.5 is wrong because it is no whole number, wherever it lies.
  const std::optional<double> whole = node.quoted ? std::nullopt : parse_number(node.text);
  if (whole && *whole != std::floor(*whole)) return must_be(value, "a whole number");
  double number = 0;
  if (!this->number(value, {max(range.min, -2147483648.0), min(range.max, 2147483647.0)}, number))
    return false;
  out = int(number);
  return true;
}

bool Reader::boolean(const Value& value, bool& out) {
  const Node& node = *value.node;
  if (node.kind != Node::Kind::text || !node.tag.empty()) return must_be(value, "true or false");
  if (node.quoted)
    return must_be(value, "true or false",
                   node.text == "true" || node.text == "false" ? "remove the quotes" : "");
  if (node.text == "true" || node.text == "false") {
    out = node.text == "true";
    return true;
  }
  const auto among = [&](std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(),
                       [&](const char* word) { return edit_distance(node.text, word) == 0; });
  };
  if (among({"yes", "on", "1", "y"})) return must_be(value, "true or false", "write true");
  if (among({"no", "off", "0", "n"})) return must_be(value, "true or false", "write false");
  return must_be(
      value, "true or false",
      nearest(node.text, {"true", "false"}).empty() ? "" : suggestion(node.text, {"true", "false"}));
}

bool Reader::numbers(const Value& value, const Range& range, double* out, std::size_t count) {
  const Node& node = *value.node;
  const std::string what = fmt::format("a list of {} numbers", count);
  if (node.kind != Node::Kind::list || !node.tag.empty()) return must_be(value, what);
  if (node.children.size() != count) {
    error(node, fmt::format("{} must be {}, not of {}", value.label, what, node.children.size()));
    return false;
  }
  bool good = true;
  for (std::size_t i = 0; i < count; ++i) {
    Value element{node.children[i], nullptr, fmt::format("number {} of {}", i + 1, value.label)};
    if (node.children[i]->kind == Node::Kind::nothing)
      element.key = &node;  // the list's place is the nearest there is
    good = number(element, range, out[i]) && good;
  }
  return good;
}

bool Reader::vector(const Value& value, const Range& range, Vec3<double>& out) {
  std::array<double, 3> v{};
  if (!numbers(value, range, v)) return false;
  out = {v[0], v[1], v[2]};
  return true;
}

bool Reader::direction(const Value& value, const Range& range, Vec3<double>& out) {
  Vec3<double> v;
  if (!vector(value, range, v)) return false;
  if (max_abs(v) < positive.min) {
    error(*value.node, value.label + " is " + text_of(v) + ", which is no direction",
          "a direction may have any length but zero");
    return false;
  }
  out = v;
  return true;
}

bool Reader::color(const Value& value, const Range& range, Rgb& out) {
  constexpr const char* forms = "a colour is [r, g, b], one number for grey, or \"#rrggbb\"";
  const Node& node = *value.node;
  if (node.kind == Node::Kind::mapping && node.tag.empty()) {
    const std::optional<Spectrum> given = spectrum(value);
    if (given) out = rgb_of(*given);
    return given.has_value();
  }
  if (node.kind == Node::Kind::list && node.tag.empty()) {
    std::array<double, 3> c{};
    if (!numbers(value, range, c)) return false;
    out = {{c[0], c[1], c[2]}};
    return true;
  }
  if (node.kind == Node::Kind::nothing) {
    // In YAML an unquoted # begins a comment, so that `color: #ff0000` says nothing at all.
    const Source& source = document_.sources[value.place().source];
    const int line = value.place().line;
    const bool comment =
        value.key != nullptr && line >= 1 && line <= int(source.lines.size()) &&
        source.lines[line - 1].find('#', std::size_t(value.place().column)) != std::string::npos;
    return must_be(value, "a colour", comment ? "a colour with # needs quotes: \"#ff8800\"" : forms);
  }
  if (node.kind != Node::Kind::text || !node.tag.empty()) return must_be(value, "a colour", forms);
  if (!node.text.empty() && node.text[0] == '#' && node.quoted) {
    const auto& t = node.text;
    bool good = t.size() == 7;
    for (std::size_t i = 1; i < t.size(); ++i) good = good && hex_digit(t[i]) >= 0;
    if (!good) return must_be(value, "a colour", "after # stand six hexadecimal digits: \"#ff8800\"");
    for (int i = 0; i < 3; ++i)
      out[i] = linear_from_srgb(
          (16 * hex_digit(t[1 + 2 * std::size_t(i)]) + hex_digit(t[2 + 2 * std::size_t(i)])) / 255.0);
    return true;
  }
  if (node.quoted || !(is_decimal(node.text) || is_not_finite(node.text)))
    return must_be(value, "a colour", forms);
  double level = 0;
  if (!number(value, range, level)) return false;
  out = {{level, level, level}};
  return true;
}

std::optional<std::vector<double>> Reader::numbers(const Value& value, const Range& range) {
  const Node& node = *value.node;
  if (node.kind != Node::Kind::list || !node.tag.empty()) {
    must_be(value, "a list of numbers");
    return {};
  }
  std::vector<double> result(node.children.size());
  if (result.empty()) {
    error(node, value.label + " is an empty list", "it has one number at least");
    return {};
  }
  if (!numbers(value, range, result.data(), result.size())) return {};
  return result;
}

std::optional<std::vector<double>> Reader::wavelengths(const Value& value) {
  auto result = numbers(value, {shortest_wavelength, longest_wavelength});
  if (!result) return {};
  for (std::size_t i = 1; i < result->size(); ++i)
    if (!((*result)[i] > (*result)[i - 1])) {
      error(*value.node->children[i],
            fmt::format("number {} of {} is not more than the one before it", i + 1, value.label),
            "wavelengths stand in growing order, each once");
      return {};
    }
  return result;
}

std::optional<Spectrum> Reader::spectrum(const Value& value) {
  const auto& fields = format().spectrum.fields;
  const auto values = mapping(value, fields, "a spectrum");
  if (!values || values->unknown_keys) return {};
  const Value *body = values->find("blackbody"), *table = values->find("values"),
              *power = values->find("power"), *at = values->find("wavelengths"),
              *factor = values->find("intensity");
  const Value* given[] = {body, table, power};
  const auto count = std::count_if(std::begin(given), std::end(given), [](auto* one) { return one; });
  if (count != 1) {
    error(
        value.place(),
        value.label + (count == 0 ? " is a mapping that gives no spectrum" : " gives more than one spectrum"),
        "a spectrum is {blackbody: KELVIN}, {wavelengths: [...], values: [...]} or {wavelengths: [...], "
        "power: [...]}");
    return {};
  }
  const auto range = [&](const char* name) { return limits(*lambent::find(fields, name)); };
  double intensity = 1;
  if (factor != nullptr && table != nullptr) {
    error(*factor->key, "'intensity' stands beside 'values', which say how much there is");
    return {};
  }
  if (factor != nullptr && !number(*factor, range("intensity"), intensity)) return {};
  if (body != nullptr) {
    if (at != nullptr) {
      error(*at->key, "'wavelengths' stands beside 'blackbody', whose light is known at all of them");
      return {};
    }
    Blackbody black;
    if (!number(*body, range("blackbody"), black.kelvin)) return {};
    return RelativeLight(black, intensity);
  }
  const Value& list = table != nullptr ? *table : *power;
  if (at == nullptr) {
    error(*list.key, list.label + " needs 'wavelengths'", "as many, in nm: at which these numbers hold");
    return {};
  }
  auto where = wavelengths(*at);
  auto numbers_there = numbers(list, range("values"));
  if (!where || !numbers_there) return {};
  if (where->size() != numbers_there->size()) {
    error(
        *list.node,
        fmt::format("{} has {} numbers, 'wavelengths' {}", list.label, numbers_there->size(), where->size()),
        "there is one for each wavelength");
    return {};
  }
  Samples samples{std::move(*where), std::move(*numbers_there)};
  if (table != nullptr) return samples;
  return RelativeLight(std::move(samples), intensity);
}

bool Reader::text(const Value& value, const std::string& what, std::string& out) {
  const Node& node = *value.node;
  if (node.kind != Node::Kind::text || !node.tag.empty()) return must_be(value, what);
  if (!node.quoted &&
      (is_decimal(node.text) || is_not_finite(node.text) || node.text == "true" || node.text == "false"))
    return must_be(value, what, "put it in quotes: \"" + node.text + "\"");
  if (node.text.empty()) {
    error(node, value.label + " is empty", "it must be " + what);
    return false;
  }
  out = node.text;
  return true;
}

bool Reader::one_of(const Value& value, const std::vector<std::string>& words, std::string& out) {
  const Node& node = *value.node;
  if (node.kind != Node::Kind::text || !node.tag.empty()) return must_be(value, "one of: " + join(words));
  if (std::find(words.begin(), words.end(), node.text) == words.end()) {
    error(node, value.label + " is " + in_quotes(node.text) + ", which is not known here",
          suggestion(node.text, words));
    return false;
  }
  out = node.text;
  return true;
}

}  // namespace lambent
