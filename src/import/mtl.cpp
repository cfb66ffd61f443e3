#include "import/mtl.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "import/paths.h"

namespace lambent {

namespace {

/// What an image may say.
enum Image : int {
  of_Ka,
  of_Kd,
  of_Ks,
  of_Ke,
  of_Ns,
  of_d,
  of_Tr,
  of_bump,
  of_norm,
  of_Pr,
  of_Pm,
  of_Pc,
  of_Pcr
};
constexpr int image_count = of_Pcr + 1;

struct ImageKey {
  std::string_view key;  ///< In lower case: exporters do not agree on it.
  Image image;
};
constexpr ImageKey image_keys[] = {
    {"map_ka", of_Ka},   {"map_kd", of_Kd}, {"map_ks", of_Ks},     {"map_ke", of_Ke}, {"map_ns", of_Ns},
    {"map_d", of_d},     {"map_tr", of_Tr}, {"map_bump", of_bump}, {"bump", of_bump}, {"norm", of_norm},
    {"map_kn", of_norm}, {"map_pr", of_Pr}, {"map_pm", of_Pm},     {"map_pc", of_Pc}, {"map_pcr", of_Pcr},
};
bool is_color(Image image) { return image <= of_Ke; }

/// A key that is understood, and nothing comes of it.
struct IgnoredKey {
  std::string_view key;  ///< In lower case.
  const char* what;      ///< Empty: nothing is lost.
};
constexpr IgnoredKey ignored_keys[] = {
    {"disp", "displacement is not supported; the surface stays as it is"},
    {"map_disp", "displacement is not supported; the surface stays as it is"},
    {"decal", "decals are not supported"},
    {"refl", "reflection maps are not supported; rays are traced instead where illum is 3 or more"},
    {"map_refl", "reflection maps are not supported; rays are traced instead where illum is 3 or more"},
    {"map_ps", "sheen is not supported"},
    {"sharpness", ""},
    {"map_aat", ""},
};

/// An image as a statement names it.
struct NamedImage {
  std::string path;
  Place place;
  bool srgb = false;
  TextureMap map;  ///< Without its texture.
};

/// What stands before or behind an image's name.
struct ImageOptions {
  TextureMap map;
  std::optional<bool> srgb;
  bool blend_u = true, blend_v = true;
  std::string_view channel, bump_factor;                          ///< Where they are given.
  std::vector<std::pair<std::string_view, const char*>> ignored;  ///< Which, and why.
};

/// What a material says, before it is understood. The words are kept for messages.
struct Written {
  std::string name;
  Place place;
  std::optional<Rgb> Ka, Kd, Ks, Ke, Tf;
  std::optional<double> Ns, Ni, d, Tr, illum, Pr, Pm, Ps, Pc, Pcr, aniso;
  std::string_view Ns_word, Ni_word, d_word, Tr_word, illum_word, Pr_word, Pm_word, Ps_word, Pc_word,
      Pcr_word, aniso_word;
  std::optional<NamedImage> images[image_count];
  bool names_map_Kd = false;  ///< Though the image may be missing.
};

class MaterialReader {
 public:
  MaterialReader(const TextFile& file, const ImportOptions& options) : file_(file), options_(options) {}

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
    const std::string lower = lower_case(key);
    const auto image_key = std::find_if(std::begin(image_keys), std::end(image_keys),
                                        [&](const ImageKey& one) { return one.key == lower; });
    if (image_key != std::end(image_keys) && current_) {
      const Place place{file_.name, file_.first_line + number_of_line - 1, int(key.data() - line.data()) + 1};
      return image(image_key->image, key, place);
    }
    const auto comment = std::find_if(words_.begin(), words_.end(), [](auto word) { return word[0] == '#'; });
    words_.erase(comment, words_.end());
    if (image_key == std::end(image_keys) && !is_known(key, lower)) return;
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
    else if (key == "Pr") number(key, line, m.Pr, m.Pr_word);
    else if (key == "Pm") number(key, line, m.Pm, m.Pm_word);
    else if (key == "Ps") number(key, line, m.Ps, m.Ps_word);
    else if (key == "Pc") number(key, line, m.Pc, m.Pc_word);
    else if (key == "Pcr") number(key, line, m.Pcr, m.Pcr_word);
    else if (key == "aniso") number(key, line, m.aniso, m.aniso_word);
    else if (key == "illum") number(key, line, m.illum, m.illum_word);
    else if (key == "d") {
      if (!words_.empty() && words_[0] == "-halo") {
        warn(words_[0], "-halo is not supported; the surface is dissolved alike from all sides");
        words_.erase(words_.begin());
      }
      number(key, line, m.d, m.d_word);
    }
  }

  /// Says what is not known or not supported, once for each key.
  bool is_known(std::string_view key, const std::string& lower) {
    static constexpr std::string_view keys[] = {"Ka",    "Kd", "Ks", "Ke", "Tf", "Ns",  "Ni",    "Tr",    "d",
                                                "illum", "Pr", "Pm", "Ps", "Pc", "Pcr", "aniso", "anisor"};
    if (std::find(std::begin(keys), std::end(keys), key) != std::end(keys)) return true;
    const auto ignored = std::find_if(std::begin(ignored_keys), std::end(ignored_keys),
                                      [&](const IgnoredKey& one) { return one.key == lower; });
    if (ignored == std::end(ignored_keys)) {
      warn_once(key, in_quotes(key) + " is no key of material libraries; it is ignored");
      return false;
    }
    if (*ignored->what != 0) warn_once(key, in_quotes(key) + " is ignored: " + ignored->what);
    return true;
  }

  // ---- images ----

  void image(Image which, std::string_view key, Place place) {
    if (which == of_Kd) current_->names_map_Kd = true;
    ImageOptions said;
    std::size_t begin = 0, end = words_.size();
    while (begin < end) {
      const std::size_t taken = option(begin, end - 1, said);
      if (taken == 0) break;
      begin += taken;
    }
    if (begin == end || words_[begin][0] == '#') return warn(key, std::string(key) + " names no file");
    for (std::size_t i = begin + 1; i < end; ++i) {
      ImageOptions with = said;
      if (!options_only(i, with)) continue;
      said = std::move(with);
      end = i;
    }
    const NamedFile* file = &find(name_of(begin, end));
    const auto comment =
        std::find_if(words_.begin() + std::ptrdiff_t(begin) + 1, words_.begin() + std::ptrdiff_t(end),
                     [](auto word) { return word[0] == '#'; });
    if (file->path.empty() && comment != words_.begin() + std::ptrdiff_t(end)) {
      end = std::size_t(comment - words_.begin());
      file = &find(name_of(begin, end));
    }
    const std::string_view name = name_of(begin, end);
    say_what_is_ignored(which, key, said);
    library_.images.push_back({std::size_t(name.data() - file_.text.data()), name.size(), file->path});
    if (file->path.empty()) return remark_missing(name, file->outside);
    NamedImage image;
    image.path = file->path;
    image.place = std::move(place);
    image.srgb = said.srgb.value_or(is_color(which));
    image.map = said.map;
    image.map.nearest = !said.blend_u && !said.blend_v;
    current_->images[which] = std::move(image);
  }

  /// From one word to another, with what stands between them.
  std::string_view name_of(std::size_t begin, std::size_t end) const {
    const char* first = words_[begin].data();
    return {first, std::size_t(words_[end - 1].data() + words_[end - 1].size() - first)};
  }

  /// Files are asked for once by each name: libraries may name one a thousand times.
  const NamedFile& find(std::string_view name) {
    const auto [at, is_new] = found_.try_emplace(std::string(name));
    if (is_new) at->second = find_named_file(file_.name, name, options_);
    return at->second;
  }

  void remark_missing(std::string_view name, bool outside) {
    if (!missing_.insert(std::string(name)).second) return;
    if (outside)
      warn(name, "image " + in_quotes(name) + " lies outside of the model's folder and is left out",
           hint_for_outside);
    else warn(name, "image " + in_quotes(name) + " is not there and is left out");
  }

  /// Whether from word `i` to the end all are options.
  bool options_only(std::size_t i, ImageOptions& said) {
    while (i < words_.size()) {
      const std::size_t taken = option(i, words_.size(), said);
      if (taken == 0) return false;
      i += taken;
    }
    return true;
  }

  /// How many words, from word `i` on and before word `end`, are an option with what belongs to it; 0 where
  /// there is none. A word that looks like one and lacks its numbers is a name.
  std::size_t option(std::size_t i, std::size_t end, ImageOptions& said) {
    const std::string_view word = words_[i];
    if (word.size() < 2 || word[0] != '-') return 0;
    TextureMap& map = said.map;
    double x[3] = {0, 0, 0};
    std::size_t count = 0;
    while (count < 3 && i + 1 + count < end) {
      const auto number = parse_number(words_[i + 1 + count]);
      if (!number) break;
      x[count++] = *number;
    }
    const std::string_view next = i + 1 < end ? words_[i + 1] : std::string_view{};
    const bool on = next == "on", off = next == "off";
    if (word == "-s" || word == "-o" || word == "-t") {
      if (count == 0) return 0;
      if (word == "-s") map.matrix[0] = x[0], map.matrix[4] = count > 1 ? x[1] : 1;
      else if (word == "-o") map.matrix[2] = x[0], map.matrix[5] = x[1];
      else if (x[0] != 0 || x[1] != 0 || x[2] != 0)
        said.ignored.emplace_back(word, "turbulence is not supported");
      return 1 + count;
    }
    if (word == "-mm") {
      if (count < 2) return 0;
      map.offset = x[0], map.gain = x[1];
      return 3;
    }
    if (word == "-bm" || word == "-boost") {
      if (count == 0) return 0;
      if (word == "-bm") map.strength = x[0], said.bump_factor = word;
      else if (x[0] != 0) said.ignored.emplace_back(word, "sharpening is not supported");
      return 2;
    }
    if (word == "-clamp" || word == "-blendu" || word == "-blendv" || word == "-cc") {
      if (!on && !off) return 0;
      if (word == "-clamp") map.wrap_u = map.wrap_v = on ? Wrap::clamp : Wrap::repeat;
      else if (word == "-blendu") said.blend_u = on;
      else if (word == "-blendv") said.blend_v = on;
      else if (on) said.ignored.emplace_back(word, "colour correction is not supported");
      return 2;
    }
    if (next.empty()) return 0;
    if (word == "-imfchan") {
      const std::size_t channel =
          next.size() == 1 ? std::string_view("rgbmlz").find(next) : std::string_view::npos;
      if (channel == std::string_view::npos) return 0;
      if (next == "z") said.ignored.emplace_back(next, "images have no depth; the luminance is taken");
      map.channel = std::int8_t(channel < 4 ? int(channel) : -1);
      said.channel = word;
      return 2;
    }
    if (word == "-texres") return 2;
    if (word == "-type") {
      said.ignored.emplace_back(word, "only reflection maps have a type");
      return 2;
    }
    if (word == "-colorspace") {
      said.srgb = lower_case(next) == "srgb";
      return 2;
    }
    return 0;
  }

  void say_what_is_ignored(Image which, std::string_view key, const ImageOptions& said) {
    for (const auto& [word, why] : said.ignored) warn_once(word, in_quotes(word) + " is ignored: " + why);
    if (said.blend_u != said.blend_v)
      warn_once(
          key,
          "-blendu and -blendv are ignored where they differ: pictures are smoothed both ways or not at all");
    if (!said.channel.empty() && (is_color(which) || which == of_norm))
      warn_once(said.channel, "'-imfchan' is ignored: " + std::string(key) + " takes the image's colour");
    if (!said.bump_factor.empty() && which != of_bump && which != of_norm)
      warn_once(said.bump_factor, "'-bm' is ignored: it belongs to bump and normal maps");
  }

  // ---- values ----

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

    int illum = m.Ks || m.images[of_Ks] ? 2 : 1;
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
    const Rgb Kd = m.Kd ? *m.Kd : grey(colorless || m.names_map_Kd ? 0.8 : 0.0);
    const Rgb Ks = m.Ks ? *m.Ks : grey(m.images[of_Ks] ? 1.0 : 0.0);
    const Rgb Ke = m.Ke ? *m.Ke : grey(m.images[of_Ke] ? 1.0 : 0.0);
    Material material;
    material.name = m.name;
    material.place = m.place;
    material.ior = 1;
    material.own["illum"] = illum;  // for the model mtl; the others do without
    const bool glass = illum == 4 || illum == 6 || illum == 7 || illum == 9;
    if (m.Pr || m.Pm || m.images[of_Pr] || m.images[of_Pm]) {
      material.own["illum"] = 2;  // the one that shades as other models do
      material.emission = Ke;
      material.opacity = d;
      physically_based(m, Kd, illum, material);
    } else if (illum == 0) {
      material.ambient = material.diffuse = Rgb{};
      material.emission = Kd + Ke;
      material.opacity = d;
      add(material, MapSlot::emission, m.images[m.images[of_Kd] ? of_Kd : of_Ke]);
    } else {
      const bool refracts = illum == 6 || illum == 7;
      const double share = glass ? d : 1;
      material.ambient = share * m.Ka.value_or(0.1 * Kd);
      material.diffuse = share * Kd;
      material.emission = Ke;
      material.opacity = glass ? 1 : d;
      if (glass) material.transmit = refracts && m.Tf ? *m.Tf : grey(1 - d);
      add(material, MapSlot::ambient, m.images[m.images[of_Ka] ? of_Ka : of_Kd]);
      add(material, MapSlot::diffuse, m.images[of_Kd]);
      add(material, MapSlot::emission, m.images[of_Ke]);
      if (illum >= 2) {
        material.specular = Ks;
        if (m.Ns) material.shininess = within(0, 1e6, "Ns", *m.Ns, m.Ns_word);
        add(material, MapSlot::specular, m.images[of_Ks]);
        add(material, MapSlot::shininess, m.images[of_Ns]);
      }
      if (illum >= 3 && illum <= 9) {
        material.reflect = material.specular;
        add(material, MapSlot::reflect, m.images[of_Ks]);
      }
      if (refracts && m.Ni) material.ior = within(0.01, 100, "Ni", *m.Ni, m.Ni_word);
    }
    add_opacity(m, material);
    add(material, MapSlot::normal, m.images[of_norm]);
    add(material, MapSlot::bump, m.images[of_bump]);
    library_.materials.push_back(std::move(material));
  }

  void physically_based(const Written& m, const Rgb& Kd, int illum, Material& material) {
    const auto share = [&](const char* key, const std::optional<double>& value, std::string_view word,
                           Image image, double otherwise) {
      return value ? within(0, 1, key, *value, word) : m.images[image] ? 1.0 : otherwise;
    };
    const double rough = m.Ns ? std::pow(2 / (within(0, 1e6, "Ns", *m.Ns, m.Ns_word) + 2), 0.25) : 0.5;
    MetallicRoughness surface;
    surface.base_color = Kd;
    surface.metallic = share("Pm", m.Pm, m.Pm_word, of_Pm, 0);
    surface.roughness = share("Pr", m.Pr, m.Pr_word, of_Pr, rough);
    surface.clearcoat = share("Pc", m.Pc, m.Pc_word, of_Pc, 0);
    surface.clearcoat_roughness = share("Pcr", m.Pcr, m.Pcr_word, of_Pcr, 0);
    if (m.Ni && *m.Ni > 1) surface.ior = within(0.01, 100, "Ni", *m.Ni, m.Ni_word);
    if (m.Tf && (illum == 6 || illum == 7))
      surface.transmission = std::min(((*m.Tf)[0] + (*m.Tf)[1] + (*m.Tf)[2]) / 3, 1.0);
    if (m.Ps && *m.Ps != 0) warn_once(m.Ps_word, "Ps is ignored: sheen is not supported");
    if (m.aniso && *m.aniso != 0) warn_once(m.aniso_word, "aniso is ignored: highlights are round");
    material.metallic_roughness = surface;
    add(material, MapSlot::base_color, m.images[of_Kd]);
    add(material, MapSlot::metallic, m.images[of_Pm]);
    add(material, MapSlot::roughness, m.images[of_Pr]);
    add(material, MapSlot::clearcoat, m.images[of_Pc]);
    add(material, MapSlot::clearcoat_roughness, m.images[of_Pcr]);
    add(material, MapSlot::emission, m.images[of_Ke]);
  }

  /// map_d, or else map_Tr: 1 - Tr (base + gain x).
  void add_opacity(const Written& m, Material& material) {
    if (m.images[of_d] || !m.images[of_Tr]) return add(material, MapSlot::opacity, m.images[of_d]);
    std::optional<NamedImage> image = m.images[of_Tr];
    const double Tr = material.opacity < 1 ? 1 - material.opacity : 1;
    image->map.offset = 1 - Tr * image->map.offset;
    image->map.gain *= -Tr;
    material.opacity = 1;  // it is in the map now
    add(material, MapSlot::opacity, image);
  }

  void add(Material& material, MapSlot slot, const std::optional<NamedImage>& image) {
    if (!image) return;
    const auto [at, is_new] =
        textures_.try_emplace({image->path, image->srgb}, std::uint32_t(library_.textures.size()));
    if (is_new) {
      Texture texture;
      texture.source.name = texture.source.file = image->path;
      texture.source.place = image->place;
      texture.srgb = image->srgb;
      library_.textures.push_back(std::move(texture));
    }
    TextureMap map = image->map;
    map.texture = at->second;
    material.maps.push_back({slot, map});
  }

  void warn(std::string_view word, std::string message, std::string hint = {}) {
    if (library_.warnings.size() < 100)
      library_.warnings.push_back(warning_at(file_, word, std::move(message), std::move(hint)));
  }
  /// What would be said the same way wherever it stands.
  void warn_once(std::string_view word, std::string message) {
    if (said_.size() < 40 && said_.insert(message).second) warn(word, std::move(message));
  }
  void fail(std::string_view word, std::string message) {
    errors_.push_back(error_at(file_, word, std::move(message)));
    if (errors_.size() == 20) throw InputError(std::move(errors_));
  }

  const TextFile& file_;
  const ImportOptions& options_;
  MaterialLibrary library_;
  std::map<std::pair<std::string, bool>, std::uint32_t> textures_;  ///< By path and whether sRGB-encoded.
  std::map<std::string, NamedFile> found_;
  std::set<std::string> missing_, said_;
  std::vector<Diagnostic> errors_;
  std::vector<std::string_view> words_;
  std::set<std::string> names_;
  std::optional<Written> current_;
  bool again_ = false;  ///< The present material has a name that is taken.
  bool stray_ = false;  ///< A statement before the first newmtl has been remarked.
};

}  // namespace

MaterialLibrary read_material_library(const TextFile& file, const ImportOptions& options) {
  return MaterialReader(file, options).read();
}

}  // namespace lambent
