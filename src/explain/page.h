#pragma once
// What a derivation is written on: text for a terminal, a LaTeX document, an HTML page. Who writes says what
// there is to say, the page how it looks.

#include <memory>
#include <string>
#include <vector>

#include "explain/math_text.h"

namespace lambent {

class Page {
 public:
  explicit Page(Notation notation) : notation_(notation) {}
  virtual ~Page() = default;

  virtual void title(const std::string& text) = 0;
  virtual void heading(const std::string& text) = 0;
  virtual void line(const std::string& text) = 0;
  /// name = sides[0] = sides[1] = ...; all in this page's notation. `remark` in words, or empty.
  virtual void equation(const std::string& name, const std::vector<std::string>& sides,
                        const std::string& remark) = 0;
  /// What follows belongs to what was said last, until `end`.
  virtual void begin() = 0;
  virtual void end() = 0;
  /// A colour, shown as one where that can be.
  virtual void swatch(const std::string& text, const int rgb[3]) = 0;
  virtual std::string finish() = 0;

  Notation notation() const { return notation_; }

 private:
  Notation notation_;
};

std::unique_ptr<Page> text_page(bool color);
std::unique_ptr<Page> latex_page();
std::unique_ptr<Page> html_page();

}  // namespace lambent
