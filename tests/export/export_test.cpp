// What is written for other renderers, and what is said of what they cannot do. That the pictures are the
// same is tested with the renderers themselves, in tests/peers.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "lambent/lambent.h"

namespace lambent {
namespace {

struct Exported {
  std::string text;
  std::vector<Diagnostic> remarks;
  bool says(const std::string& part) const {
    return std::any_of(remarks.begin(), remarks.end(),
                       [&](const Diagnostic& d) { return d.message.find(part) != std::string::npos; });
  }
  int count(const std::string& word) const {
    int n = 0;
    for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += word.size()) ++n;
    return n;
  }
};
Exported exported(const std::string& yaml, ExportFormat format) {
  Exported result;
  result.text = export_scene(parse_scene(yaml), format, result.remarks);
  return result;
}
const std::string head = "lambent: 1\ncamera: {eye: [0, 1, 5], target: [0, 0, 0]}\nimage: {size: [64, 48]}\n";

TEST(Export, APlainSceneHasNoRemarks) {
  const std::string yaml = head + R"(
illumination: {model: phong, attenuation: none, ambient_attenuation: none}
lights: [{point: {position: [3, 4, 5]}}]
materials: [{name: a, diffuse: 0.5, specular: 0.3}]
objects:
  - {sphere: {center: [0, 0, 0], radius: 1}, material: a}
  - {plane: {point: [0, -1, 0], normal: [0, 1, 0]}, material: a}
)";
  for (const ExportFormat format : {ExportFormat::povray, ExportFormat::tachyon}) {
    const Exported out = exported(yaml, format);
    for (const Diagnostic& remark : out.remarks) ADD_FAILURE() << to_string(remark);
    EXPECT_EQ(out.count(format == ExportFormat::povray ? "\nsphere {" : "\nSPHERE "), 1);
    EXPECT_EQ(out.count(format == ExportFormat::povray ? "\nplane {" : "\nPLANE "), 1);
  }
}

TEST(Export, LightsWithExtentAreGridsOfPointsOrPoints) {
  const std::string yaml = head + R"(
illumination: {model: phong, attenuation: none, ambient_attenuation: none}
lights:
  - {name: panel, rectangle: {center: [0, 4, 0], u: [2, 0, 0], v: [0, 0, 1], samples: 9, two_sided: true}}
  - {name: spotlight, disc: {center: [3, 4, 0], normal: [0, -1, 0], radius: 0.5, visible: false}}
  - {name: bulb, sphere: {center: [-3, 4, 0], radius: 0.5, samples: 16}}
)";
  const Exported pov = exported(yaml, ExportFormat::povray), dat = exported(yaml, ExportFormat::tachyon);
  EXPECT_EQ(pov.count("light_source {"), 3);
  EXPECT_EQ(pov.count(" area_light <2, 0, 0>, <0, 0, 1>, 3, 3 "), 1);
  EXPECT_EQ(pov.count(", 4, 4 circular orient"), 1);
  EXPECT_EQ(pov.count("polygon {"), 1);
  EXPECT_EQ(pov.count("sphere {"), 1);
  EXPECT_EQ(pov.count("disc {"), 0) << "not visible";
  EXPECT_TRUE(pov.says("light 'panel' is meant to shine by the cosine to its normal"));
  EXPECT_TRUE(
      pov.says("light 'spotlight' is meant to shine by the cosine to its normal, and on one side alone"));
  EXPECT_FALSE(pov.says("light 'bulb'"));
  EXPECT_EQ(dat.count("\nLIGHT CENTER"), 3);
  for (const char* name : {"panel", "spotlight", "bulb"})
    EXPECT_TRUE(
        dat.says("has no lights with extent; light '" + std::string(name) + "' is a point, its centre"));
}

TEST(Export, InstancesAreWrittenOut) {
  const std::string mesh =
      "mesh: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], triangles: [[0, 1, 2], [0, 2, 3]]}";
  const std::string yaml =
      head + "objects:\n  - {" + mesh + "}\n  - {" + mesh + ", transform: {translate: [1, 2, 3]}}\n";
  const Exported pov = exported(yaml, ExportFormat::povray), dat = exported(yaml, ExportFormat::tachyon);
  EXPECT_EQ(pov.count("mesh2 {"), 2);
  EXPECT_EQ(pov.count(",\n<2, 2, 3>"), 1);  // (1, 0, 0) moved
  EXPECT_EQ(dat.count("\nTRI "), 4);
  EXPECT_EQ(dat.count(" -2 2 3 "), 1);  // and x turned round
}

TEST(Export, WhatPovrayCannotSayIsSaid) {
  const Exported out = exported(head + R"(
illumination: {model: phong, attenuation: {linear: 1, quadratic: 1}, ambient_attenuation: 1/R}
integrator: {whitted: {colored_shadows: false}}
lights: [{name: lamp, point: {position: [3, 4, 5], max_distance: 10}}]
materials:
  - {name: tinted, specular: [1, 0.5, 0.2], transmit: [0.5, 0.2, 0.2]}
  - {name: halfway, model: blinn_phong_halfway, specular: 1}
  - {name: far, model: opengl, specular: 1}
  - {name: fresnel, model: mtl, illum: 5, specular: 1}
  - {name: fast, model: tachyon, highlight: 2, specular: 1}
  - {name: clear, transmit: 1}
  - {name: unused, specular: [1, 0, 0]}
objects:
  - {sphere: {center: [0, 0, 0], radius: 1}, material: tinted}
  - {sphere: {center: [0, 0, 0], radius: 1}, material: halfway}
  - {sphere: {center: [0, 0, 0], radius: 1}, material: far}
  - {sphere: {center: [0, 0, 0], radius: 1}, material: fresnel}
  - {sphere: {center: [0, 0, 0], radius: 1}, material: fast}
  - {sphere: {center: [0, 0, 0], radius: 1}, material: clear}
)",
                                ExportFormat::povray);
  for (const char* part :
       {"one power of the distance; of the attenuation of light 'lamp'", "no max_distance; light 'lamp'",
        "no ambient term that fades; that of material 'tinted'",
        "tints what shines through by the pigment; material 'tinted'",
        "the light's colour; that of material 'tinted'", "material 'tinted' is meant to cast a full shadow",
        "half-vector; the highlight of material 'halfway'",
        "sees highlights from the eye; that of material 'far'",
        "material 'far' is meant to be lit by the outside's normal",
        "no Fresnel factor on highlights; that of material 'fresnel'", "reflected totally; material 'tinted'",
        "no fast highlights; that of material 'fast'", "that of material 'fast' is meant to stay",
        "what transmits all; that of material 'clear'"})
    EXPECT_TRUE(out.says(part)) << part;
  EXPECT_FALSE(out.says("'unused'"));
  for (const Diagnostic& remark : out.remarks) EXPECT_EQ(remark.severity, Severity::warning);
  const auto placed = std::find_if(out.remarks.begin(), out.remarks.end(), [](const Diagnostic& d) {
    return d.message.find("'halfway'") != std::string::npos;
  });
  EXPECT_EQ(placed->place.line, 10);
}

TEST(Export, WhatTachyonCannotSayIsSaid) {
  const Exported out = exported(head + R"(
illumination: {model: phong, attenuation: 1/r, ambient_attenuation: none}
background: 0.1
lights: [{name: beam, spot: {position: [3, 4, 5], target: [0, 0, 0], exponent: 2}}]
materials:
  - {name: odd, ambient: [0.1, 0, 0], diffuse: [0, 0.5, 0], specular: 0.2, reflect: [0.5, 0, 0]}
  - {name: glass, transmit: 0.5, ior: 1.5}
  - {name: two, model: povray, specular: 0.2, pov_specular: 0.3, brilliance: 2}
  - {name: half, model: blinn_phong, specular: 0.2}
objects:
  - {name: egg, sphere: {center: [0, 0, 0], radius: 1}, material: odd, transform: {scale: [1, 2, 1]}}
  - {name: roof, cone: {from: [0, 0, 0], to: [0, 1, 0], radius_from: 1, radius_to: 0}, material: glass}
  - {sphere: {center: [0, 0, 0], radius: 1}, material: two}
  - {sphere: {center: [0, 0, 0], radius: 1}, material: half}
)",
                                ExportFormat::tachyon);
  for (const char* part :
       {"in proportion to the angle; that of light 'beam'",
        "one colour for all terms; the ambient term of material 'odd'",
        "one number for reflection; that of material 'odd'", "mirror ray no further; material 'odd'",
        "in a spot's edge; that of material 'odd'",
        "does not refract; light goes straight on through material 'glass'",
        "one highlight; of material 'two'", "the brilliance of material 'two'",
        "one form of highlight for the whole picture", "object 'egg' is left out",
        "object 'roof' is left out", "no minimum_distance"})
    EXPECT_TRUE(out.says(part)) << part;
  EXPECT_EQ(out.count("\nSPHERE "), 2);
}

TEST(Export, MetalAndOpacityAreWrittenInTheLecturesNumbers) {
  // A metal as rough as can be is Lambert's: diffuse 0.5; half of it is there, the rest shows through.
  const auto out = exported(head + R"(
illumination: {model: conventional, ambient: 0, ambient_occlusion: {}}
background: {file: studio}
materials: [{name: chalk, opacity: 0.5, one_sided: true, metallic_roughness: {base_color: 0.5}}]
objects: [{sphere: {center: [0, 0, 0], radius: 1}, material: chalk}]
)",
                            ExportFormat::povray);
  EXPECT_NE(out.text.find("transmit 0.5"), std::string::npos) << out.text;
  EXPECT_NE(out.text.find("color rgb <0.5, 0.5, 0.5>"), std::string::npos)
      << out.text;  // 0.25 of the 0.5 left
  EXPECT_TRUE(out.says("image around the scene"));
  EXPECT_TRUE(out.says("ambient occlusion"));
  EXPECT_TRUE(out.says("'chalk' is one-sided"));
}

TEST(Export, NamesCannotBreakOutOfTheirComments) {
  const std::string yaml = head + R"(
materials: [{name: "a\nsphere { 0, 1 }", diffuse: 0.5}]
objects: [{plane: {point: [0, -1, 0], normal: [0, 1, 0]}, material: "a\nsphere { 0, 1 }"}]
)";
  EXPECT_EQ(exported(yaml, ExportFormat::povray).count("\nsphere"), 0);
}

TEST(Export, AFaceIsFlatWhereACornerHasNoNormal) {
  const std::string yaml = head + R"(
objects:
  - mesh:
      vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]
      normals: [[0, 0, 0], [0, 0.6, 0.8], [0.6, 0, 0.8], [0, 0, 1]]
      triangles: [[0, 1, 2], [1, 3, 2]]
)";
  const Exported pov = exported(yaml, ExportFormat::povray), dat = exported(yaml, ExportFormat::tachyon);
  EXPECT_EQ(pov.count("normal_vectors { 4,\n<0, 0, 1>,\n"), 1) << pov.text;
  EXPECT_EQ(pov.count("normal_indices { 2,\n<0, 0, 0>,\n<1, 2, 3> }"), 1) << pov.text;
  EXPECT_EQ(dat.count("\nTRI "), 1);
  EXPECT_EQ(dat.count("\nSTRI "), 1);
}

}  // namespace
}  // namespace lambent
