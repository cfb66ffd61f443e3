#include "import/mtl.h"

#include <gtest/gtest.h>

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
    const bool refracts = illum == 6 || illum == 7;
    EXPECT_EQ(m.ior, refracts ? 1.5 : 1) << illum;
    EXPECT_EQ(m.transmit, refracts ? (Rgb{{0.9, 0.8, 0.7}}) : (Rgb{{0.25, 0.25, 0.25}})) << illum;
  }
  EXPECT_EQ(material("Kd 0 0 0\nd 0.25\nNi 1.5\nillum 6\n").transmit, (Rgb{{0.75, 0.75, 0.75}}));  // no Tf
  EXPECT_EQ(material("Kd 0 0 0\nillum 6\n").ior, 1);                                               // no Ni
}

TEST(Mtl, DissolvedSurfacesKeepTheirShare) {
  const Material m = material("Ka 0.4 0.4 0.4\nKd 0.8 0.4 0\nKs 1 1 1\nd 0.25\nNi 1.5\nillum 2\n");
  EXPECT_EQ(m.ambient, (Rgb{{0.1, 0.1, 0.1}}));
  EXPECT_EQ(m.diffuse, (Rgb{{0.2, 0.1, 0}}));
  EXPECT_EQ(m.specular, (Rgb{{1, 1, 1}}));
  EXPECT_EQ(m.transmit, (Rgb{{0.75, 0.75, 0.75}}));
  EXPECT_EQ(m.ior, 1);  // what is merely dissolved does not bend light
}

TEST(Mtl, TrIsTheRestOfD) {
  EXPECT_EQ(material("Kd 1 1 1\nTr 0.25\n").transmit, material("Kd 1 1 1\nd 0.75\n").transmit);
  EXPECT_EQ(warnings_of("newmtl m\nd 0.7\nTr 0.3\n"), Strings{});
  for (const char* both : {"Tr 0.5\nd 0.75\n", "d 0.75\nTr 0.5\n"}) {
    EXPECT_EQ(material(both).transmit, (Rgb{{0.25, 0.25, 0.25}}));
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

TEST(Mtl, KnownKeysThatAreNotUsedAreSilent) {
  EXPECT_EQ(warnings_of("newmtl m\nmap_Kd -s 1 1 1 a b.png\nmap_Bump -bm 2 c.png\nbump d\ndisp e\ndecal "
                        "f\nrefl -type sphere g\nnorm h\n"
                        "sharpness 60\nPr 0.5\nPm 1\nPs 0\nPc 0\nPcr 0\naniso 0\nanisor 0\nmap_Pr i\n"),
            Strings{});
}

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
  EXPECT_EQ(material("d -halo 0.25\n").transmit, (Rgb{{0.75, 0.75, 0.75}}));
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
