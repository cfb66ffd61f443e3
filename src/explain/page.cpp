#include "explain/page.h"

#include <fmt/format.h>

namespace lambent {
namespace {

constexpr std::size_t width = 80;

/// Names come from files by anybody: nothing in them shall command a terminal.
std::string harmless(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return text;
}

class TextPage : public Page {
 public:
  explicit TextPage(bool color) : Page(Notation::text), color_(color) {}

  void title(const std::string& text) override { put(bold(harmless(text))); }
  void heading(const std::string& text) override {
    text_ += '\n';
    put(bold(harmless(text)));
  }
  void line(const std::string& text) override { put(harmless(text)); }
  void equation(const std::string& name, const std::vector<std::string>& sides,
                const std::string& remark) override {
    std::string so_far = fmt::format("{:<9}", name);
    const std::size_t margin = so_far.size();
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const std::string side = " = " + sides[i];
      if (i > 0 && indent_ + so_far.size() + side.size() > width) {
        put(so_far, margin + 3);
        so_far = std::string(margin, ' ') + side;
      } else so_far += side;
    }
    if (!remark.empty()) {
      if (indent_ + so_far.size() + 3 + remark.size() > width) {
        put(so_far, margin + 3);
        so_far = std::string(margin + 3, ' ') + remark;
      } else so_far += "   " + remark;
    }
    put(so_far, margin + 3);
  }
  void begin() override { indent_ += 2; }
  void end() override { indent_ -= 2; }
  void swatch(const std::string& text, const int rgb[3]) override {
    put(color_ ? fmt::format("\x1b[48;2;{};{};{}m    \x1b[0m {}", rgb[0], rgb[1], rgb[2], text) : text);
  }
  std::string finish() override { return std::move(text_); }

 private:
  std::string bold(const std::string& text) const { return color_ ? "\x1b[1m" + text + "\x1b[0m" : text; }
  /// A line, broken at spaces where it is too long; what follows stands `hang` further in.
  void put(const std::string& text, std::size_t hang = 2) {
    std::string rest = text;
    std::size_t margin = indent_;
    for (bool first = true;; first = false) {
      const std::size_t room = width - std::min(margin, width - 20);
      std::size_t end = rest.size();
      if (color_ && rest.find('\x1b') != std::string::npos) {
      }  // its escapes take no room
      else if (rest.size() > room) {
        end = rest.rfind(' ', room);
        if (end == std::string::npos || rest.find_first_not_of(' ') > end) end = rest.find(' ', room);
        if (end == std::string::npos) end = rest.size();
      }
      if (!rest.empty()) text_ += std::string(margin, ' ') + rest.substr(0, end);
      text_ += '\n';
      if (end >= rest.size()) return;
      rest.erase(0, end + 1);
      if (first) margin += hang;
    }
  }

  bool color_;
  std::size_t indent_ = 0;
  std::string text_;
};

class LatexPage : public Page {
 public:
  LatexPage() : Page(Notation::latex) {}
  void title(const std::string& text) override {
    text_ +=
        "\\documentclass{article}\n\\usepackage{amsmath}\n\\usepackage[margin=2cm]{geometry}\n"
        "\\setlength{\\parindent}{0pt}\n\\begin{document}\n\\section*{" +
        plain(text) + "}\n";
  }
  void heading(const std::string& text) override { text_ += "\n\\paragraph{" + plain(text) + "}~\\\\\n"; }
  void line(const std::string& text) override { text_ += plain(text) + "\n\n"; }
  void equation(const std::string& name, const std::vector<std::string>& sides,
                const std::string& remark) override {
    text_ += "\\begin{align*}\n  " + label(name);
    for (std::size_t i = 0; i < sides.size(); ++i) text_ += (i ? " \\\\\n  &= " : " &= ") + sides[i];
    if (!remark.empty()) text_ += " && \\text{" + plain(remark) + "}";
    text_ += "\n\\end{align*}\n";
  }
  void begin() override { text_ += "\\begin{quote}\n"; }
  void end() override { text_ += "\\end{quote}\n"; }
  void swatch(const std::string& text, const int*) override { line(text); }
  std::string finish() override { return std::move(text_) + "\\end{document}\n"; }

 private:
  static std::string label(const std::string& name) {
    return name.size() < 3 ? written(name, Notation::latex) : "\\text{" + plain(name) + "}";
  }
  static std::string plain(const std::string& text) {
    std::string result;
    for (const char c : text) {
      if (c == '\\') result += "\\textbackslash{}";
      else if (c == '^') result += "\\^{}";
      else if (c == '~') result += "\\~{}";
      else if (c == '<' || c == '>' || c == '|') result += std::string("$") + c + "$";
      else if (std::string_view("#$%&_{}").find(c) != std::string_view::npos) result += std::string("\\") + c;
      else result += c;
    }
    return result;
  }
  std::string text_;
};

class HtmlPage : public Page {
 public:
  HtmlPage() : Page(Notation::mathml) {}
  void title(const std::string& text) override {
    text_ += "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + plain(text) +
             "</title>\n<style>\nbody { font-family: sans-serif; max-width: 60em; margin: 2em auto; padding: "
             "0 1em; }\n"
             "section { border-left: 2px solid #ccc; padding-left: 1em; margin: 0.5em 0; }\n"
             "math { margin: 0.3em 0; }\n.remark { color: #555; padding-left: 2em; }\n"
             ".swatch { display: inline-block; width: 2em; height: 1em; border: 1px solid #888; }\n"
             "</style>\n</head>\n<body>\n<h1>" +
             plain(text) + "</h1>\n";
  }
  void heading(const std::string& text) override { text_ += "<h3>" + plain(text) + "</h3>\n"; }
  void line(const std::string& text) override { text_ += "<p>" + plain(text) + "</p>\n"; }
  void equation(const std::string& name, const std::vector<std::string>& sides,
                const std::string& remark) override {
    text_ += "<div><math display=\"inline\"><mrow>" +
             (name.size() < 3 ? written(name, Notation::mathml) : "<mtext>" + plain(name) + "</mtext>");
    for (const std::string& side : sides) text_ += "<mo>=</mo>" + side;
    text_ += "</mrow></math>";
    if (!remark.empty()) text_ += "<span class=\"remark\">" + plain(remark) + "</span>";
    text_ += "</div>\n";
  }
  void begin() override { text_ += "<section>\n"; }
  void end() override { text_ += "</section>\n"; }
  void swatch(const std::string& text, const int rgb[3]) override {
    text_ +=
        fmt::format("<p><span class=\"swatch\" style=\"background: #{:02x}{:02x}{:02x}\"></span> {}</p>\n",
                    rgb[0], rgb[1], rgb[2], plain(text));
  }
  std::string finish() override { return std::move(text_) + "</body>\n</html>\n"; }

 private:
  static std::string plain(const std::string& text) {
    std::string result;
    for (const char c : text) {
      if (c == '<') result += "&lt;";
      else if (c == '>') result += "&gt;";
      else if (c == '&') result += "&amp;";
      else if (c == '"') result += "&quot;";
      else result += c;
    }
    return result;
  }
  std::string text_;
};

}  // namespace

std::unique_ptr<Page> text_page(bool color) { return std::make_unique<TextPage>(color); }
std::unique_ptr<Page> latex_page() { return std::make_unique<LatexPage>(); }
std::unique_ptr<Page> html_page() { return std::make_unique<HtmlPage>(); }

}  // namespace lambent
