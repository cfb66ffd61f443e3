#include "import/mtl.h"

#include <gtest/gtest.h>

#include "support.h"

namespace lambent {
namespace {

using Strings = std::vector<std::string>;

MaterialLibrary mtl(const std::string& text) { return read_material_library(text_file("a.mtl", text)); }

/// The one material that these lines describe.
Material material(const std::string& lines) {
  const MaterialLibrary library = mtl("newmtl m\n" + lines);
  EXPECT_EQ(library.materials.size(), 1u);
  return library.materials.at(0);
}

Strings warnings_of(const std::string& text) {
  Strings result;
  for (const Diagnostic& d : mtl(text).warnings) result.push_back(to_string(d));
  return result;
}

Strings errors_of(const std::string& text) {
  Strings result;
  try {
    mtl(text);
  } catch (const InputError& error) {
    for (const Diagnostic& d : error.diagnostics()) result.push_back(to_string(d));
  }
  return result;
}

constexpr Rgb black{{0, 0, 0}};

/// The library that `text` makes as a file beside images of these names.
MaterialLibrary with_images(const std::string& text,
                            const std::vector<std::string>& images = {"a.png", "b.png"}) {
  const test::TemporaryDirectory folder;
  for (const std::string& name : images) test::write_text(folder.file(name), "any bytes");
  return read_material_library(text_file(folder.file("a.mtl"), text));
}
/// The first map of a slot; fails where there is none.
TextureMap map_of(const Material& material, MapSlot slot) {
  for (const MaterialMap& map : material.maps)
    if (map.slot == slot) return map.map;
  ADD_FAILURE() << "no map of slot " << int(slot);
  return {};
}
std::vector<MapSlot> slots_of(const Material& material) {
  std::vector<MapSlot> result;
  for (const MaterialMap& map : material.maps) result.push_back(map.slot);
  return result;
}
using Slots = std::vector<MapSlot>;
/// The map that these options before a.png make of a statement `key`.
TextureMap map_with(const std::string& options, const std::string& key = "map_Kd",
                    MapSlot slot = MapSlot::diffuse) {
  return map_of(with_images("newmtl m\n" + key + " " + options + " a.png\n").materials.at(0), slot);
}
Strings messages(const MaterialLibrary& library) {
  Strings result;
  for (const Diagnostic& d : library.warnings) result.push_back(d.message);
  return result;
}

TEST(Mtl, NamesAndPlaces) {
  const MaterialLibrary library =
      mtl("# a library\nnewmtl red\nKd 1 0 0\n\n  newmtl  Hard Shiny Plastic \r\nKd 0 1 0\r\n");
  ASSERT_EQ(library.materials.size(), 2u);
  EXPECT_EQ(library.materials[0].name, "red");
  EXPECT_EQ(to_string(library.materials[0].place), "a.mtl:2:1");
  EXPECT_EQ(library.materials[1].name, "Hard Shiny Plastic");
  EXPECT_EQ(to_string(library.materials[1].place), "a.mtl:5:3");
  EXPECT_TRUE(library.warnings.empty());
  EXPECT_TRUE(mtl("").materials.empty());
}

TEST(Mtl, Illum0IsItsColourAlone) {
  const Material m = material("Ka 1 1 1\nKd 0.2 0.4 0.6\nKs 1 1 1\nKe 0.5 0 0\nd 0.5\nillum 0\n");
  EXPECT_EQ(m.emission, (Rgb{{0.7, 0.4, 0.6}}));
  EXPECT_EQ(m.ambient, black);
  EXPECT_EQ(m.diffuse, black);
  EXPECT_EQ(m.specular, black);
  EXPECT_EQ(m.reflect, black);
  EXPECT_EQ(m.transmit, black);
}

TEST(Mtl, IllumIsKeptForTheModel) {
  for (int illum = 0; illum <= 10; ++illum)
    EXPECT_EQ(material("illum " + std::to_string(illum) + "\n").own,
              (std::map<std::string, double>{{"illum", illum}}));
  EXPECT_EQ(material("Ks 1 1 1\n").own.at("illum"), 2);
  EXPECT_EQ(material("Kd 1 1 1\n").own.at("illum"), 1);
}

TEST(Mtl, Illum1HasNoHighlight) {
  for (const char* illum : {"Ks 1 1 1\nillum 1\n", ""}) {
    const Material m = material(std::string("Ka 0.1 0.2 0.3\nKd 0.4 0.5 0.6\nNs 7\n") + illum);
    EXPECT_EQ(m.ambient, (Rgb{{0.1, 0.2, 0.3}}));
    EXPECT_EQ(m.diffuse, (Rgb{{0.4, 0.5, 0.6}}));
    EXPECT_EQ(m.specular, black);
    EXPECT_EQ(m.reflect, black);
  }
}

TEST(Mtl, Illum2HasOne) {
  for (const char* illum : {"illum 2\n", "illum 10\n", ""}) {  // and where Ks stands without an illum
    const Material m = material(std::string("Kd 0.4 0.5 0.6\nKs 0.7 0.8 0.9\nNs 96.5\nNi 1.45\n") + illum);
    EXPECT_EQ(m.specular, (Rgb{{0.7, 0.8, 0.9}}));
    EXPECT_EQ(m.shininess, 96.5);
    EXPECT_EQ(m.reflect, black);
    EXPECT_EQ(m.transmit, black);
    EXPECT_EQ(m.ior, 1);
  }
}

TEST(Mtl, Illum3To9Reflect) {
  for (int illum = 0; illum <= 10; ++illum) {
    const Material m = material("Kd 0 0 0\nKs 0.25 0.5 0.75\nillum " + std::to_string(illum) + "\n");
    EXPECT_EQ(m.reflect, illum >= 3 && illum <= 9 ? (Rgb{{0.25, 0.5, 0.75}}) : black) << illum;
    EXPECT_EQ(m.transmit, black) << illum;
  }
}

TEST(Mtl, RefractionBendsByNiAndTintsByTf) {
  for (int illum = 1; illum <= 10; ++illum) {
    const Material m =
        material("Kd 0.5 0.5 0.5\nTf 0.9 0.8 0.7\nNi 1.5\nd 0.75\nillum " + std::to_string(illum) + "\n");
    const bool refracts = illum == 6 || illum == 7, glass = refracts || illum == 4 || illum == 9;
    EXPECT_EQ(m.ior, refracts ? 1.5 : 1) << illum;
    EXPECT_EQ(m.transmit, refracts ? (Rgb{{0.9, 0.8, 0.7}})
                          : glass  ? (Rgb{{0.25, 0.25, 0.25}})
                                   : black)
        << illum;
    EXPECT_EQ(m.opacity, glass ? 1 : 0.75) << illum;
  }
  EXPECT_EQ(material("Kd 0 0 0\nd 0.25\nNi 1.5\nillum 6\n").transmit, (Rgb{{0.75, 0.75, 0.75}}));  // no Tf
  EXPECT_EQ(material("Kd 0 0 0\nillum 6\n").ior, 1);                                               // no Ni
}

TEST(Mtl, DissolvedSurfacesAreThereInPart) {
  for (const char* illum : {"0", "1", "2", "3", "5", "8", "10"}) {
    const Material m = material(
        std::string("Ka 0.4 0.4 0.4\nKd 0.8 0.4 0\nKs 1 1 1\nd 0.25\nNi 1.5\nillum ") + illum + "\n");
    EXPECT_EQ(m.opacity, 0.25);
    EXPECT_EQ(m.transmit, black);
    EXPECT_EQ(m.ior, 1);  // what is merely dissolved does not bend light
    if (illum[0] != '0') {
      EXPECT_EQ(m.ambient, (Rgb{{0.4, 0.4, 0.4}}));
      EXPECT_EQ(m.diffuse, (Rgb{{0.8, 0.4, 0}}));
    }
  }
}

TEST(Mtl, GlassKeepsItsHighlights) {
  for (const char* illum : {"4", "9"}) {
    const Material m = material(
        std::string("Ka 0.4 0.4 0.4\nKd 0.8 0.4 0\nKs 1 1 1\nd 0.25\nNi 1.5\nillum ") + illum + "\n");
    EXPECT_EQ(m.ambient, (Rgb{{0.1, 0.1, 0.1}}));
    EXPECT_EQ(m.diffuse, (Rgb{{0.2, 0.1, 0}}));
    EXPECT_EQ(m.specular, (Rgb{{1, 1, 1}}));
    EXPECT_EQ(m.transmit, (Rgb{{0.75, 0.75, 0.75}}));
    EXPECT_EQ(m.opacity, 1);
    EXPECT_EQ(m.ior, 1);
  }
}

TEST(Mtl, TrIsTheRestOfD) {
  EXPECT_EQ(material("Kd 1 1 1\nTr 0.25\n").opacity, 0.75);
  EXPECT_EQ(warnings_of("newmtl m\nd 0.7\nTr 0.3\n"), Strings{});
  for (const char* both : {"Tr 0.5\nd 0.75\n", "d 0.75\nTr 0.5\n"}) {
    EXPECT_EQ(material(both).opacity, 0.75);
    const int line = both[0] == 'T' ? 2 : 3;
    EXPECT_EQ(warnings_of(std::string("newmtl m\n") + both),
              (Strings{"a.mtl:" + std::to_string(line) +
                       ":4: warning: Tr contradicts d, of which it should be 1 - d; d is used\n"
                       "    Tr 0.5\n"
                       "       ^"}));
  }
}

TEST(Mtl, WhatIsNotGiven) {
  EXPECT_EQ(material("Kd 0.5 1 0\n").ambient, 0.1 * (Rgb{{0.5, 1, 0}}));
  EXPECT_EQ(material("Ka 0 0 0\nKd 0.5 1 0\n").ambient, black);
  EXPECT_EQ(material("Ka 1 1 1\nKd 0.5 1 0\n").ambient, (Rgb{{1, 1, 1}}));
  EXPECT_EQ(material("").diffuse, (Rgb{{0.8, 0.8, 0.8}}));
  EXPECT_EQ(material("map_Kd wood.png\nKs 1 1 1\n").diffuse, (Rgb{{0.8, 0.8, 0.8}}));
  EXPECT_EQ(material("Ks 1 1 1\nillum 3\n").diffuse, black);
  EXPECT_EQ(material("Ke 3 2 1\n").diffuse, black);
  EXPECT_EQ(material("Ke 3 2 1\n").emission, (Rgb{{3, 2, 1}}));
}

TEST(Mtl, OneNumberIsAGrey) { EXPECT_EQ(material("Kd 0.5 # half\n").diffuse, (Rgb{{0.5, 0.5, 0.5}})); }

TEST(Mtl, KeysOfWhichNothingIsLost) {
  EXPECT_EQ(
      warnings_of("newmtl m\nsharpness 60\nmap_aat on\nPr 0.5\nPm 1\nPs 0\nPc 0\nPcr 0\naniso 0\nanisor 0\n"),
      Strings{});
}

TEST(Mtl, KeysThatAreNotSupportedGiveOneWarningEach) {
  EXPECT_EQ(
      warnings_of("newmtl m\ndisp e\nrefl -type sphere g\nnewmtl n\ndisp e\n"),
      (Strings{
          "a.mtl:2:1: warning: 'disp' is ignored: displacement is not supported; the surface stays as it is\n"
          "    disp e\n"
          "    ^",
          "a.mtl:3:1: warning: 'refl' is ignored: reflection maps are not supported; rays are traced "
          "instead where illum is 3 or more\n"
          "    refl -type sphere g\n"
          "    ^"}));
  EXPECT_EQ(mtl("newmtl m\ndecal f\nmap_Ps g\nPr 0\nPs 1\naniso 0.5\n").warnings.size(), 4u);
}

// ---- images ----

TEST(Mtl, ImagesMultiplyWhatTheyAreNamedAfter) {
  const MaterialLibrary library = with_images(
      "newmtl m\nKa 1 1 1\nKd 0.5 0.5 0.5\nKs 1 1 1\nKe 2 2 2\nNs 50\nillum 2\nmap_Ka a.png\nmap_Kd b.png\n"
      "map_Ks a.png\nmap_Ns a.png\nmap_Ke a.png\nmap_d a.png\nmap_Bump -bm 0.3 b.png\nnorm a.png\n");
  ASSERT_EQ(messages(library), Strings{});
  const Material& m = library.materials.at(0);
  EXPECT_EQ(slots_of(m), (Slots{MapSlot::ambient, MapSlot::diffuse, MapSlot::emission, MapSlot::specular,
                                MapSlot::shininess, MapSlot::opacity, MapSlot::normal, MapSlot::bump}));
  // a.png as colour, b.png as colour, a.png as data, b.png as data: one entry each.
  ASSERT_EQ(library.textures.size(), 4u);
  const auto texture = [&](MapSlot slot) { return library.textures.at(map_of(m, slot).texture); };
  EXPECT_TRUE(texture(MapSlot::ambient).srgb && texture(MapSlot::specular).srgb &&
              texture(MapSlot::emission).srgb);
  EXPECT_EQ(map_of(m, MapSlot::ambient).texture, map_of(m, MapSlot::specular).texture);
  EXPECT_EQ(map_of(m, MapSlot::shininess).texture, map_of(m, MapSlot::opacity).texture);
  EXPECT_FALSE(texture(MapSlot::shininess).srgb || texture(MapSlot::bump).srgb ||
               texture(MapSlot::normal).srgb);
  EXPECT_EQ(std::filesystem::path(texture(MapSlot::diffuse).source.file).filename(), "b.png");
  EXPECT_EQ(map_of(m, MapSlot::bump).strength, 0.3);
  EXPECT_EQ(map_of(m, MapSlot::bump).channel, -1);
  EXPECT_EQ(texture(MapSlot::diffuse).source.place.line, 9);
}

TEST(Mtl, WhereImagesGoByIllum) {
  const std::string all = "newmtl m\nKd 1 1 1\nKs 1 1 1\nmap_Kd a.png\nmap_Ks b.png\nillum ";
  EXPECT_EQ(slots_of(with_images(all + "0\n").materials.at(0)), (Slots{MapSlot::emission}));
  EXPECT_EQ(slots_of(with_images(all + "1\n").materials.at(0)), (Slots{MapSlot::ambient, MapSlot::diffuse}));
  EXPECT_EQ(slots_of(with_images(all + "2\n").materials.at(0)),
            (Slots{MapSlot::ambient, MapSlot::diffuse, MapSlot::specular}));
  EXPECT_EQ(slots_of(with_images(all + "3\n").materials.at(0)),
            (Slots{MapSlot::ambient, MapSlot::diffuse, MapSlot::specular, MapSlot::reflect}));
}

TEST(Mtl, AnImageWithoutItsColour) {
  const Material m = with_images("newmtl m\nmap_Ks a.png\nmap_Ke a.png\nmap_Kd a.png\n").materials.at(0);
  EXPECT_EQ(m.diffuse, (Rgb{{0.8, 0.8, 0.8}}));
  EXPECT_EQ(m.specular, (Rgb{{1, 1, 1}}));
  EXPECT_EQ(m.emission, (Rgb{{1, 1, 1}}));
  EXPECT_EQ(m.own.at("illum"), 2);
  // Where the image is missing, so is what it would have brought.
  const Material without = material("map_Ks a.png\nmap_Ke a.png\nmap_Kd a.png\n");
  EXPECT_EQ(without.diffuse, (Rgb{{0.8, 0.8, 0.8}}));
  EXPECT_EQ(without.specular, black);
  EXPECT_EQ(without.emission, black);
  EXPECT_TRUE(without.maps.empty());
}

TEST(Mtl, OptionsOfImages) {
  const TextureMap plain = map_with("");
  EXPECT_EQ(plain.matrix, (std::array<double, 6>{1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(plain.wrap_u, Wrap::repeat);
  EXPECT_EQ(map_with("-s 2").matrix, (std::array<double, 6>{2, 0, 0, 0, 1, 0}));
  EXPECT_EQ(map_with("-s 2 3 4 -o 0.5 0.25 0").matrix, (std::array<double, 6>{2, 0, 0.5, 0, 3, 0.25}));
  EXPECT_EQ(map_with("-o 0.1").matrix, (std::array<double, 6>{1, 0, 0.1, 0, 1, 0}));
  EXPECT_EQ(map_with("-mm 0.1 0.3").offset, 0.1);
  EXPECT_EQ(map_with("-mm 0.1 0.3").gain, 0.3);
  EXPECT_EQ(map_with("-clamp on").wrap_u, Wrap::clamp);
  EXPECT_EQ(map_with("-clamp on").wrap_v, Wrap::clamp);
  EXPECT_EQ(map_with("-clamp on -clamp off").wrap_u, Wrap::repeat);
  EXPECT_FALSE(map_with("-blendu on -blendv on").nearest);
  EXPECT_TRUE(map_with("-blendu off -blendv off").nearest);
  const std::pair<std::string, int> channels[] = {{"r", 0}, {"g", 1}, {"b", 2}, {"m", 3}, {"l", -1}};
  for (const auto& [letter, channel] : channels)
    EXPECT_EQ(map_with("-imfchan " + letter, "map_d", MapSlot::opacity).channel, channel) << letter;
  EXPECT_FALSE(with_images("newmtl m\nmap_Kd -colorspace linear a.png\n").textures.at(0).srgb);
  EXPECT_TRUE(with_images("newmtl m\nbump -colorspace sRGB a.png\n").textures.at(0).srgb);
  EXPECT_EQ(messages(with_images("newmtl m\nmap_Kd -texres 512 -boost 0 -t 0 0 0 -cc off a.png\n")),
            Strings{});
}

TEST(Mtl, OptionsThatAreNotSupportedAreSaid) {
  const std::pair<const char*, const char*> options[] = {
      {"map_Kd -t 0.1 0.2", "'-t' is ignored: turbulence is not supported"},
      {"map_Kd -boost 2", "'-boost' is ignored: sharpening is not supported"},
      {"map_Kd -cc on", "'-cc' is ignored: colour correction is not supported"},
      {"map_Kd -type sphere", "'-type' is ignored: only reflection maps have a type"},
      {"map_Kd -imfchan r", "'-imfchan' is ignored: map_Kd takes the image's colour"},
      {"map_Kd -bm 2", "'-bm' is ignored: it belongs to bump and normal maps"},
      {"map_d -imfchan z", "'z' is ignored: images have no depth; the luminance is taken"},
      {"map_Kd -blendu off",
       "-blendu and -blendv are ignored where they differ: pictures are smoothed both ways or not at all"},
  };
  for (const auto& [statement, message] : options) {
    const std::string line = std::string(statement) + " a.png\n";
    EXPECT_EQ(messages(with_images("newmtl m\n" + line + line)), Strings{message});
  }
}

TEST(Mtl, NamesOfImages) {
  const std::vector<std::string> files{"a b.png", "#1.png", "7", "c.png"};
  const auto name = [&](const std::string& statement) {
    const MaterialLibrary library = with_images("newmtl m\n" + statement + "\n", files);
    return library.textures.empty()
               ? ""
               : std::filesystem::path(library.textures[0].source.file).filename().string();
  };
  EXPECT_EQ(name("map_Kd a b.png"), "a b.png");
  EXPECT_EQ(name("map_Kd  -s 1 1 1  a b.png  "), "a b.png");
  EXPECT_EQ(name("map_Kd a b.png # wood"), "a b.png");
  EXPECT_EQ(name("map_bump a b.png -bm 1.5 -imfchan r"), "a b.png");  // behind it, as some exporters write
  EXPECT_EQ(name("map_Kd C:\\made\\there\\c.png"), "c.png");
  EXPECT_EQ(name("map_Kd .\\c.png"), "c.png");
  EXPECT_EQ(name("map_Kd -o 1 7"), "7");  // the last word is the name
  EXPECT_EQ(name("MAP_KD c.png"), "c.png");
  EXPECT_EQ(name("map_Kd d.png"), "");
  EXPECT_EQ(warnings_of("newmtl m\nmap_Kd -s 2 2 my wood.png\nmap_Ka my wood.png\nmap_Ks\nbump -bm 1\n"),
            (Strings{"a.mtl:2:15: warning: image 'my wood.png' is not there and is left out\n"
                     "    map_Kd -s 2 2 my wood.png\n"
                     "                  ^",
                     "a.mtl:4:1: warning: map_Ks names no file\n"
                     "    map_Ks\n"
                     "    ^",
                     "a.mtl:5:6: warning: image '-bm 1' is not there and is left out\n"
                     "    bump -bm 1\n"
                     "         ^"}));
}

TEST(Mtl, ImagesOutsideAreLeftOut) {
  const test::TemporaryDirectory folder;
  std::filesystem::create_directory(folder.file("model"));
  test::write_text(folder.file("wood.png"), "any bytes");
  const TextFile file = text_file(folder.file("model/a.mtl"), "newmtl m\nmap_Kd ../wood.png\n");
  const MaterialLibrary library = read_material_library(file);
  EXPECT_TRUE(library.materials.at(0).maps.empty());
  EXPECT_EQ(messages(library),
            Strings{"image '../wood.png' lies outside of the model's folder and is left out"});
  EXPECT_EQ(library.warnings.at(0).hint, "--allow-outside lets files name files that lie elsewhere");
  ImportOptions options;
  options.limits.allow_outside = true;
  EXPECT_EQ(read_material_library(file, options).textures.size(), 1u);
}

TEST(Mtl, TransparencyByImage) {
  const auto opacity = [](const std::string& lines) {
    const Material m = with_images("newmtl m\nKd 1 1 1\n" + lines + "map_Tr a.png\n").materials.at(0);
    const TextureMap map = map_of(m, MapSlot::opacity);
    return std::array<double, 3>{m.opacity, map.offset, map.gain};
  };
  using Three = std::array<double, 3>;
  EXPECT_EQ(opacity(""), (Three{1, 1, -1}));
  EXPECT_EQ(opacity("d 1\n"), (Three{1, 1, -1}));
  EXPECT_EQ(opacity("Tr 0.5\n"), (Three{1, 1, -0.5}));
  const Material both = with_images("newmtl m\nd 0.5\nmap_Tr a.png\nmap_d b.png\n").materials.at(0);
  EXPECT_EQ(slots_of(both), (Slots{MapSlot::opacity}));
  EXPECT_EQ(map_of(both, MapSlot::opacity).gain, 1);
  EXPECT_EQ(both.opacity, 0.5);
}

// ---- physically based ----

TEST(Mtl, PhysicallyBased) {
  const MaterialLibrary library = with_images(
      "newmtl m\nKd 0.5 0.25 1\nKs 1 1 1\nKe 0.1 0 0\nPr 0.2\nPm 0.3\nPc 0.4\nPcr 0.6\nNi 1.33\nd 0.9\nillum "
      "5\n"
      "map_Kd a.png\nmap_Pr a.png\nmap_Pm b.png\nmap_Pc a.png\nmap_Pcr a.png\nmap_Ke a.png\nnorm "
      "a.png\nmap_Ks a.png\n");
  ASSERT_EQ(messages(library), Strings{});
  const Material& m = library.materials.at(0);
  ASSERT_TRUE(m.metallic_roughness);
  EXPECT_EQ(m.metallic_roughness->base_color, (Rgb{{0.5, 0.25, 1}}));
  EXPECT_EQ(m.metallic_roughness->roughness, 0.2);
  EXPECT_EQ(m.metallic_roughness->metallic, 0.3);
  EXPECT_EQ(m.metallic_roughness->clearcoat, 0.4);
  EXPECT_EQ(m.metallic_roughness->clearcoat_roughness, 0.6);
  EXPECT_EQ(m.metallic_roughness->ior, 1.33);
  EXPECT_EQ(m.emission, (Rgb{{0.1, 0, 0}}));
  EXPECT_EQ(m.opacity, 0.9);
  EXPECT_EQ(m.own.at("illum"), 2);
  EXPECT_EQ(slots_of(m),
            (Slots{MapSlot::base_color, MapSlot::metallic, MapSlot::roughness, MapSlot::clearcoat,
                   MapSlot::clearcoat_roughness, MapSlot::emission, MapSlot::normal}));
  EXPECT_FALSE(library.textures.at(map_of(m, MapSlot::roughness).texture).srgb);
}

TEST(Mtl, WhatIsNotGivenOfThePhysicallyBased) {
  const auto surface = [](const std::string& lines) {
    return with_images("newmtl m\n" + lines).materials.at(0).metallic_roughness.value();
  };
  EXPECT_EQ(surface("Pm 1\n").roughness, 0.5);
  EXPECT_DOUBLE_EQ(surface("Pm 1\nNs 30\n").roughness, 0.5);  // (2 / 32)^(1/4)
  EXPECT_EQ(surface("map_Pr a.png\n").roughness, 1);
  EXPECT_EQ(surface("map_Pr a.png\n").metallic, 0);
  EXPECT_EQ(surface("map_Pm a.png\n").metallic, 1);
  EXPECT_EQ(surface("Pr 0\n").ior, 1.5);
  EXPECT_EQ(surface("Pr 0\nNi 1\n").ior, 1.5);
  EXPECT_EQ(surface("Pr 0\nTf 0.5 0.5 0.5\nillum 6\n").transmission, 0.5);
  EXPECT_EQ(surface("Pr 0\nTf 1 1 1\nillum 2\n").transmission, 0);
  EXPECT_EQ(surface("Pr 0\n").base_color, (Rgb{{0.8, 0.8, 0.8}}));
  EXPECT_FALSE(material("Kd 1 1 1\nPc 1\n").metallic_roughness);
}

// ---- what is odd ----

TEST(Mtl, UnknownKeysGiveOneWarningEach) {
  EXPECT_EQ(warnings_of("newmtl m\nKt 1 1 1\nKm 0.5\nKt 1 1 1\n"),
            (Strings{"a.mtl:2:1: warning: 'Kt' is no key of material libraries; it is ignored\n"
                     "    Kt 1 1 1\n"
                     "    ^",
                     "a.mtl:3:1: warning: 'Km' is no key of material libraries; it is ignored\n"
                     "    Km 0.5\n"
                     "    ^"}));
}

TEST(Mtl, WhatIsNotSupportedIsSaid) {
  EXPECT_EQ(
      warnings_of("newmtl m\nKd spectral red.rfl 1\nKs xyz 0.1 0.2 0.3\nd -halo 0.5\n"),
      (Strings{"a.mtl:2:4: warning: a colour given as 'spectral' is not supported; Kd is ignored\n"
               "    Kd spectral red.rfl 1\n"
               "       ^",
               "a.mtl:3:4: warning: a colour given as 'xyz' is not supported; Ks is ignored\n"
               "    Ks xyz 0.1 0.2 0.3\n"
               "       ^",
               "a.mtl:4:3: warning: -halo is not supported; the surface is dissolved alike from all sides\n"
               "    d -halo 0.5\n"
               "      ^"}));
  EXPECT_EQ(material("d -halo 0.25\n").opacity, 0.25);
}

TEST(Mtl, ValuesOutOfRangeAreBroughtIntoIt) {
  EXPECT_EQ(warnings_of("newmtl m\nKd -1 0 0\nKs 1 1 1\nNs -5\nd 1.5\nillum 12\n"),
            (Strings{"a.mtl:2:4: warning: Kd must not be negative; 0 is used\n"
                     "    Kd -1 0 0\n"
                     "       ^",
                     "a.mtl:6:7: warning: illum must be a whole number from 0 to 10; 2 is used\n"
                     "    illum 12\n"
                     "          ^",
                     "a.mtl:5:3: warning: d must lie between 0 and 1; 1 is used\n"
                     "    d 1.5\n"
                     "      ^",
                     "a.mtl:4:4: warning: Ns must lie between 0 and 1000000; 0 is used\n"
                     "    Ns -5\n"
                     "       ^"}));
  EXPECT_EQ(material("Ks 1 1 1\nNs 2e6\n").shininess, 1e6);
  EXPECT_EQ(material("Ni 0\nillum 7\n").ior, 0.01);
  EXPECT_EQ(warnings_of("newmtl m\nNi 0\n"), Strings{});  // it bends nothing, so it harms nobody
}

TEST(Mtl, TheFirstOfEqualNamesHolds) {
  const std::string text = "newmtl m\nKd 1 0 0\nnewmtl m\nKd 0 1 0\nnewmtl n\nKd 0 0 1\n";
  const MaterialLibrary library = mtl(text);
  ASSERT_EQ(library.materials.size(), 2u);
  EXPECT_EQ(library.materials[0].diffuse, (Rgb{{1, 0, 0}}));
  EXPECT_EQ(library.materials[1].name, "n");
  EXPECT_EQ(warnings_of(text),
            (Strings{"a.mtl:3:8: warning: material 'm' is defined again; the first definition holds\n"
                     "    newmtl m\n"
                     "           ^"}));
}

TEST(Mtl, StatementsBeforeTheFirstMaterial) {
  EXPECT_EQ(warnings_of("Kd 1 0 0\nKs 1 1 1\nnewmtl m\n"),
            (Strings{"a.mtl:1:1: warning: 'Kd' stands before the first newmtl; it is ignored\n"
                     "    Kd 1 0 0\n"
                     "    ^"}));
}

TEST(Mtl, WhatIsNoNumberIsAnError) {
  EXPECT_EQ(errors_of("newmtl m\nKd 1 0\nKs 1 0 nan\nNs\nillum two\n"),
            (Strings{"a.mtl:2:7: error: Kd needs one number or three, found 2\n"
                     "    Kd 1 0\n"
                     "          ^",
                     "a.mtl:3:8: error: 'nan' is not a number\n"
                     "    Ks 1 0 nan\n"
                     "           ^",
                     "a.mtl:4:3: error: Ns needs a number\n"
                     "    Ns\n"
                     "      ^",
                     "a.mtl:5:7: error: 'two' is not a number\n"
                     "    illum two\n"
                     "          ^"}));
  std::string many = "newmtl m\n";
  for (int i = 0; i < 50; ++i) many += "Kd x\n";
  EXPECT_EQ(errors_of(many).size(), 20u);
}

}  // namespace
}  // namespace lambent
