#pragma once
// Strict reading of values: each has its type, its range and its place, and what is wrong is said and
// remembered, so that one run finds all there is.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lambent/diagnostics.h"
#include "scenefile/document.h"
#include "scenefile/format.h"
#include "scenefile/names.h"
#include "spectra/spectrum.h"

namespace lambent {

/// A value, and how to speak of it.
struct Value {
  const Node* node = nullptr;  ///< The value itself.
  const Node* key = nullptr;   ///< The key it stands behind, or null in a list.
  std::string label;           ///< "'fov'", "number 2 of 'eye'".
  /// Where complaints point: an empty value has no place of its own in its text.
  const Node& place() const {
    const bool empty = node->kind == Node::Kind::nothing && key != nullptr && key->source == node->source;
    return empty ? *key : *node;
  }
};

/// A mapping whose keys have been looked at.
struct Values {
  Value whole;
  std::vector<Value> values;
  bool unknown_keys = false;
  const Value* find(std::string_view key) const;
};

class Reader {
 public:
  explicit Reader(const Document& document) : document_(document) {}
  const Document& document() const { return document_; }

  void error(const Node& at, std::string message, std::string hint = {});
  /// A remark with a place of its own (a model file's), reported because of `at`.
  void error(const Node& at, Diagnostic diagnostic);
  /// All that was found so far, in the order of the file.
  std::vector<Diagnostic> errors() const;
  bool good() const { return found_.empty(); }
  /// How many errors there are so far.
  std::size_t count() const { return found_.size(); }

  /// The keys of a mapping: unknown and repeated ones, merges, and missing ones are reported. Nothing if it
  /// is no mapping.
  std::optional<Values> mapping(const Value& value, const std::vector<Field>& fields,
                                const std::string& what);
  /// The elements of a list; nothing if it is none. `element` names one: "vertex", "light".
  std::optional<std::vector<Value>> list(const Value& value, const std::string& element);

  // Each says whether `out` was set; if not, why has been reported.
  bool number(const Value& value, const Range& range, double& out);
  bool integer(const Value& value, const Range& range, int& out);
  bool boolean(const Value& value, bool& out);
  bool color(const Value& value, const Range& range, Rgb& out);
  /// Any number of numbers, one at least.
  std::optional<std::vector<double>> numbers(const Value& value, const Range& range);
  /// The same at growing wavelengths.
  std::optional<std::vector<double>> wavelengths(const Value& value);
  /// What a mapping says of a colour at every wavelength.
  std::optional<Spectrum> spectrum(const Value& value);
  bool vector(const Value& value, const Range& range, Vec3<double>& out);
  bool direction(const Value& value, const Range& range, Vec3<double>& out);
  bool text(const Value& value, const std::string& what, std::string& out);
  /// Exactly `out.size()` numbers.
  template <std::size_t N> bool numbers(const Value& value, const Range& range, std::array<double, N>& out) {
    return numbers(value, range, out.data(), N);
  }
  bool numbers(const Value& value, const Range& range, double* out, std::size_t count);

  /// One of the words of E.
  template <class E> bool choice(const Value& value, E& out) {
    std::string word;
    if (!one_of(value, names_of<E>(), word)) return false;
    out = *meaning_of<E>(word);
    return true;
  }
  bool one_of(const Value& value, const std::vector<std::string>& words, std::string& out);

  /// Every parameter of S's table that `values` holds.
  template <class S> bool table(const Values& values, const std::vector<Field>& fields, S& out) {
    const std::size_t before = count();
    for (const Parameter<S>& parameter : parameters_of<S>) {
      const Value* value = values.find(parameter.name);
      const Field* field = lambent::find(fields, parameter.name);
      if (value == nullptr || field == nullptr) continue;
      const Range range = limits(*field);
      std::visit([&](auto member) { member_of(*value, range, parameter.kind, out.*member); },
                 parameter.member);
    }
    return count() == before;
  }
  /// The colours of S's table that `values` gives as spectra.
  template <class S> std::map<std::string, Spectrum> spectra(const Values& values) {
    std::map<std::string, Spectrum> result;
    for (const Parameter<S>& parameter : parameters_of<S>) {
      const Value* value = values.find(parameter.name);
      if (value == nullptr || value->node->kind != Node::Kind::mapping ||
          !std::holds_alternative<Rgb S::*>(parameter.member))
        continue;
      if (auto found = spectrum(*value)) result.emplace(parameter.name, std::move(*found));
    }
    return result;
  }

 private:
  void member_of(const Value& value, const Range& range, Kind, double& out) { number(value, range, out); }
  void member_of(const Value& value, const Range& range, Kind, int& out) { integer(value, range, out); }
  void member_of(const Value& value, const Range&, Kind, bool& out) { boolean(value, out); }
  void member_of(const Value& value, const Range&, Kind, std::string& out) { text(value, "text", out); }
  void member_of(const Value& value, const Range& range, Kind, Rgb& out) { color(value, range, out); }
  void member_of(const Value& value, const Range& range, Kind kind, Vec3<double>& out) {
    kind == Kind::direction ? direction(value, range, out) : vector(value, range, out);
  }
  bool must_be(const Value& value, const std::string& what, std::string hint = {});
  bool in_range(const Value& value, double number, const Range& range);

  struct Found {
    int source, line, column;
    Diagnostic diagnostic;
  };
  const Document& document_;
  std::vector<Found> found_;
};

}  // namespace lambent
