#include "import/mtl.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace lambent {

namespace {

/// What a material says, before it is understood. The words are kept for messages.
struct Written {
  std::string name;
  Place place;
  std::optional<Rgb> Ka, Kd, Ks, Ke, Tf;
  std::optional<double> Ns, Ni, d, Tr, illum;
  std::string_view Ns_word, Ni_word, d_word, Tr_word, illum_word;
  bool map_Kd = false;
};

class MaterialReader {
 public:
  explicit MaterialReader(const TextFile& file) : file_(file) {}

  MaterialLibrary read() {
    LineReader lines(file_.text, true);
    while (lines.next()) statement(lines.line, lines.number);
    finish();
    if (!errors_.empty()) throw InputError(std::move(errors_));
    return std::move(library_);
  }

 private:
  void statement(std::string_view line, int number_of_line) {
    std::string_view rest = line;
    const std::string_view key = next_word(rest);
    if (key.empty() || key[0] == '#') return;
    if (key == "newmtl")
      return begin({file_.name, number_of_line, int(key.data() - line.data()) + 1}, key, trim(rest));
    split_words(rest, words_);
    const auto comment = std::find_if(words_.begin(), words_.end(), [](auto word) { return word[0] == '#'; });
    words_.erase(comment, words_.end());
    if (!is_known(key)) {
      if (unknown_.size() < 20 && unknown_.insert(std::string(key)).second)
        warn(key, in_quotes(key) + " is no key of material libraries; it is ignored");
      return;
    }
    if (!current_) {
      if (!stray_) warn(key, in_quotes(key) + " stands before the first newmtl; it is ignored");
      stray_ = true;
      return;
    }
    Written& m = *current_;
    if (key == "Ka") color(key, line, m.Ka);
    else if (key == "Kd") color(key, line, m.Kd);
    else if (key == "Ks") color(key, line, m.Ks);
    else if (key == "Ke") color(key, line, m.Ke);
    else if (key == "Tf") color(key, line, m.Tf);
    else if (key == "Ns") number(key, line, m.Ns, m.Ns_word);
    else if (key == "Ni") number(key, line, m.Ni, m.Ni_word);
    else if (key == "Tr") number(key, line, m.Tr, m.Tr_word);
    else if (key == "illum") number(key, line, m.illum, m.illum_word);
    else if (key == "map_Kd") m.map_Kd = true;
    else if (key == "d") {
      if (!words_.empty() && words_[0] == "-halo") {
        warn(words_[0], "-halo is not supported; the surface is dissolved alike from all sides");
        words_.erase(words_.begin());
      }
      number(key, line, m.d, m.d_word);
    }
  }

  static bool is_known(std::string_view key) {
    static constexpr std::string_view keys[] = {
        "Ka",   "Kd",    "Ks",   "Ke",   "Tf", "Ns", "Ni", "Tr", "d",   "illum", "sharpness", "bump",
        "disp", "decal", "refl", "norm", "Pr", "Pm", "Ps", "Pc", "Pcr", "aniso", "anisor"};
    return key.substr(0, 4) == "map_" || std::find(std::begin(keys), std::end(keys), key) != std::end(keys);
  }

  void begin(Place place, std::string_view key, std::string_view name) {
    finish();
    current_.emplace();
    current_->name = name;
    current_->place = std::move(place);
    if (names_.insert(current_->name).second) return;
    warn(name.empty() ? key : name,
         "material " + in_quotes(current_->name) + " is defined again; the first definition holds");
    again_ = true;
  }

  void color(std::string_view key, std::string_view line, std::optional<Rgb>& result) {
    if (!words_.empty() && (words_[0] == "spectral" || words_[0] == "xyz")) {
      warn(words_[0], "a colour given as " + in_quotes(words_[0]) + " is not supported; " + std::string(key) +
                          " is ignored");
      return;
    }
    if (words_.empty() || words_.size() == 2)
      return fail(end_of(line),
                  std::string(key) + " needs one number or three, found " + std::to_string(words_.size()));
    Rgb value;
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = words_.size() == 1 ? words_[0] : words_[i];
      const auto x = parse_number(word);
      if (!x) return fail(word, in_quotes(word) + " is not a number");
      if (*x < 0 && (i == 0 || words_.size() > 1))
        warn(word, std::string(key) + " must not be negative; 0 is used");
      value[i] = std::max(*x, 0.0);
    }
    result = value;
  }

  void number(std::string_view key, std::string_view line, std::optional<double>& result,
              std::string_view& where) {
    if (words_.empty()) return fail(end_of(line), std::string(key) + " needs a number");
    const auto x = parse_number(words_[0]);
    if (!x) return fail(words_[0], in_quotes(words_[0]) + " is not a number");
    result = x;
    where = words_[0];
  }

  /// `value`, brought into its range with a warning.
  double within(double low, double high, const char* key, double value, std::string_view word) {
    if (value >= low && value <= high) return value;
    const double used = std::clamp(value, low, high);
    warn(word, std::string(key) + " must lie between " + plain(low) + " and " + plain(high) + "; " +
                   plain(used) + " is used");
    return used;
  }
  static std::string plain(double x) {
    std::string text = std::to_string(x);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
  }

  /// The rules that stand at the head of mtl.h.
  void finish() {
    if (!current_) return;
    const Written m = std::move(*current_);
    current_.reset();
    if (std::exchange(again_, false)) return;

    int illum = m.Ks ? 2 : 1;
    if (m.illum) {
      if (*m.illum >= 0 && *m.illum <= 10 && *m.illum == std::floor(*m.illum)) illum = int(*m.illum);
      else
        warn(m.illum_word,
             "illum must be a whole number from 0 to 10; " + std::to_string(illum) + " is used");
    }
    double d = 1;
    if (m.d) d = within(0, 1, "d", *m.d, m.d_word);
    else if (m.Tr) d = 1 - within(0, 1, "Tr", *m.Tr, m.Tr_word);
    // Exporters round to a few digits.
    if (m.d && m.Tr && std::abs(*m.d + *m.Tr - 1) > 1e-3)
      warn(m.Tr_word, "Tr contradicts d, of which it should be 1 - d; d is used");

    const bool colorless = !m.Ks && !m.Tf && !m.Ke;
    const Rgb Kd = m.Kd ? *m.Kd : grey(colorless || m.map_Kd ? 0.8 : 0.0);
    const Rgb Ke = m.Ke.value_or(Rgb{});
    Material material;
    material.name = m.name;
    material.place = m.place;
    material.ior = 1;
    material.own["illum"] = illum;  // for the model mtl; the others do without
    if (illum == 0) {
      material.ambient = material.diffuse = Rgb{};
      material.emission = Kd + Ke;
    } else {
      const bool refracts = illum == 6 || illum == 7;
      material.ambient = d * m.Ka.value_or(0.1 * Kd);
      material.diffuse = d * Kd;
      material.emission = Ke;
      material.transmit = refracts && m.Tf ? *m.Tf : grey(1 - d);
      if (illum >= 2) material.specular = m.Ks.value_or(Rgb{});
      if (illum >= 2 && m.Ns) material.shininess = within(0, 1e6, "Ns", *m.Ns, m.Ns_word);
      if (illum >= 3 && illum <= 9) material.reflect = material.specular;
      if (refracts && m.Ni) material.ior = within(0.01, 100, "Ni", *m.Ni, m.Ni_word);
    }
    library_.materials.push_back(std::move(material));
  }

  void warn(std::string_view word, std::string message) {
    if (library_.warnings.size() < 100)
      library_.warnings.push_back(warning_at(file_, word, std::move(message)));
  }
  void fail(std::string_view word, std::string message) {
    errors_.push_back(error_at(file_, word, std::move(message)));
    if (errors_.size() == 20) throw InputError(std::move(errors_));
  }

  const TextFile& file_;
  MaterialLibrary library_;
  std::vector<Diagnostic> errors_;
  std::vector<std::string_view> words_;
  std::set<std::string> names_, unknown_;
  std::optional<Written> current_;
  bool again_ = false;  ///< The present material has a name that is taken.
  bool stray_ = false;  ///< A statement before the first newmtl has been remarked.
};

}  // namespace

MaterialLibrary read_material_library(const TextFile& file) { return MaterialReader(file).read(); }

}  // namespace lambent
