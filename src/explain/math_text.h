#pragma once
// Formulas made readable: simplified, and written as text, LaTeX or MathML; with symbols, or with the numbers
// put in.

#include <string>
#include <vector>

#include "explain/traced.h"

namespace lambent {

/// A formula for one colour: the same steps in each channel, or a plain triple of numbers where they differ.
struct MathTerm {
  enum class Kind {
    number,
    symbol,
    sum,
    difference,
    product,
    quotient,
    power,
    positive_part,
    root,
    negative,
    absolute
  };
  Kind kind = Kind::number;
  Rgb value{};
  std::string name;  ///< symbol.
  std::vector<MathTerm> parts;
};

/// What c's channels were made by, without what does not matter: factors of 1, summands of 0, the branches
/// and the bounds that were not taken.
MathTerm simplified(const Formulas& formulas, const Color<Traced>& c);
MathTerm simplified(const Formulas& formulas, const Traced& number);

/// The symbols of a formula, each once, in the order of its text.
std::vector<const MathTerm*> symbols_of(const MathTerm& term);

enum class Notation { text, latex, mathml };
enum class Filled { symbols, numbers };
std::string written(const MathTerm& term, Notation notation, Filled filled);
/// A symbol or a short formula in plain letters, such as "2 (N.L) N - L" or "Kd".
std::string written(const std::string& plain, Notation notation);

/// "0.7071", "1.3e-05": four digits.
std::string short_number(double value);
/// The same for a colour: one number where all channels are alike, else "0.8 0.1 0.1".
std::string short_color(const Rgb& color);
std::string written(const Rgb& color, Notation notation);

}  // namespace lambent
