// What the reader says, word for word, and what it takes.

#include <gtest/gtest.h>

#include <string>

#include "lambent/image.h"
#include "scene/scene.h"
#include "scenefile/errors.h"
#include "scenefile/format.h"
#include "scenefile/nearest.h"
#include "support.h"

namespace lambent::test {
namespace {

TEST(ReaderMessages, MisspeltKey) {
  EXPECT_EQ(report("lambent: 1\ncamera: {eye: [0, 0, 5], taget: [0, 0, 0]}\n"),
            R"(scene.yaml:2:26: error: unknown key 'taget' in the camera
    camera: {eye: [0, 0, 5], taget: [0, 0, 0]}
                             ^
    hint: did you mean 'target'?
)");
}

TEST(ReaderMessages, UnknownKeyThatResemblesNone) {
  EXPECT_EQ(report(head + "illumination: {attenuation: {falloff: 3}}\n"),
            R"(scene.yaml:3:30: error: unknown key 'falloff' in an attenuation
    illumination: {attenuation: {falloff: 3}}
                                 ^
    hint: known are: constant, linear, quadratic
)");
}

TEST(ReaderMessages, RepeatedKey) {
  EXPECT_EQ(report(head + "image: {samples: 4}\nimage: {samples: 5}\n"),
            R"(scene.yaml:4:1: error: 'image' stands here a second time
    image: {samples: 5}
    ^
    hint: the first is in line 3; remove one of them
)");
}

TEST(ReaderMessages, MissingKey) {
  EXPECT_EQ(report(head + "objects:\n  - sphere: {center: [0, 0, 0]}\n"),
            R"(scene.yaml:4:5: error: a sphere needs 'radius'
      - sphere: {center: [0, 0, 0]}
        ^
    hint: radius (number, scene units): The radius.
)");
}

TEST(ReaderMessages, WrongType) {
  EXPECT_EQ(report("lambent: 1\ncamera: {eye: [0, 0, 5], target: here, fov: [40]}\n"),
            R"(scene.yaml:2:34: error: 'target' must be a list of 3 numbers, not 'here'
    camera: {eye: [0, 0, 5], target: here, fov: [40]}
                                     ^
scene.yaml:2:45: error: 'fov' must be a number, not a list
    camera: {eye: [0, 0, 5], target: here, fov: [40]}
                                                ^
)");
}

TEST(ReaderMessages, OutOfRange) {
  EXPECT_EQ(report("lambent: 1\ncamera: {eye: [0, 0, 5], target: [0, 0, 0], fov: 200}\n"),
            R"(scene.yaml:2:50: error: 'fov' is 200, but must be 0.01 to 179
    camera: {eye: [0, 0, 5], target: [0, 0, 0], fov: 200}
                                                     ^
)");
}

TEST(ReaderMessages, NotFinite) {
  EXPECT_EQ(report("lambent: 1\ncamera: {eye: [0, .nan, 5], target: [0, 0, 0]}\n"),
            R"(scene.yaml:2:19: error: number 2 of 'eye' must be a finite number, not '.nan'
    camera: {eye: [0, .nan, 5], target: [0, 0, 0]}
                      ^
)");
}

TEST(ReaderMessages, EmptyValue) {
  EXPECT_EQ(report(head + "image:\n  samples:\n"), R"(scene.yaml:4:3: error: 'samples' has no value
      samples:
      ^
    hint: it must be a whole number
)");
}

TEST(ReaderMessages, ColourThatIsAComment) {
  EXPECT_EQ(report(head + "background: #ff8800\n"), R"(scene.yaml:3:1: error: 'background' has no value
    background: #ff8800
    ^
    hint: a colour with # needs quotes: "#ff8800"
)");
}

TEST(ReaderMessages, MergeKey) {
  EXPECT_EQ(report(head + "image: {<<: {samples: 4}}\n"),
            R"(scene.yaml:3:9: error: merging with '<<' is not part of the format
    image: {<<: {samples: 4}}
            ^
    hint: write the keys out, or name the whole value with an alias
)");
}

TEST(ReaderMessages, NotYaml) {
  EXPECT_EQ(report(head + "image: {size: [1, 2}\n"),
            R"(scene.yaml:3:20: error: this is not YAML: did not find expected ',' or ']'
    image: {size: [1, 2}
                       ^
    hint: a list that opens with [ must close with ], with commas between its elements
)");
}

TEST(ReaderMessages, WhereAThingIsNotClosedItsBeginningIsShown) {
  EXPECT_EQ(report(head + "image: {size: [1, 2\n"),
            R"(scene.yaml:3:15: error: this is not YAML: did not find expected ',' or ']'
    image: {size: [1, 2
                  ^
    hint: a list that opens with [ must close with ], with commas between its elements
)");
  EXPECT_EQ(report(head + "background: \"#fff\n\n"),
            R"(scene.yaml:3:13: error: this is not YAML: found unexpected end of stream
    background: "#fff
                ^
    hint: a quote is not closed
)");
}

TEST(ReaderMessages, OneBracketTooMany) {
  EXPECT_EQ(report(head + "image: {size: [1, 2]}}\n"),
            R"(scene.yaml:3:22: error: this is not YAML: did not find expected key
    image: {size: [1, 2]}}
                         ^
    hint: there is one closing bracket too many, or of the wrong kind
)");
}

TEST(ReaderMessages, AliasOfNothing) {
  EXPECT_EQ(report(head + "background: *sky\n"),
            R"(scene.yaml:3:13: error: this is not YAML: no value before this one is named &sky
    background: *sky
                ^
    hint: an alias *sky repeats a value that was written as &sky ...
)");
}

TEST(ReaderMessages, EmptyElementAtItsDash) {
  EXPECT_EQ(report(head + "objects:\n  -\n").substr(0, 15), "scene.yaml:4:3:");
  EXPECT_EQ(report(head + "objects:\n  - # none\n").substr(0, 15), "scene.yaml:4:3:");
}

TEST(ReaderMessages, UnknownMaterial) {
  EXPECT_EQ(report(head + "materials: [{name: red}]\nobjects:\n  - {sphere: {center: [0, 0, 0], radius: 1}, "
                          "material: rde}\n"),
            R"(scene.yaml:5:56: error: there is no material 'rde'
      - {sphere: {center: [0, 0, 0], radius: 1}, material: rde}
                                                           ^
    hint: did you mean 'red'?
)");
}

TEST(ReaderMessages, UnknownModel) {
  EXPECT_EQ(report(head + "illumination: {model: fong}\n"),
            R"(scene.yaml:3:23: error: 'model' is 'fong', which is not known here
    illumination: {model: fong}
                          ^
    hint: did you mean 'phong'?
)");
}

TEST(ReaderMessages, UnknownVersion) {
  EXPECT_EQ(report("lambent: 2\ncamera: {eye: [0, 0, 5], target: [0, 0, 0]}\n"),
            R"(scene.yaml:1:10: error: this is version 2 of the format; only version 1 is known
    lambent: 2
             ^
    hint: write lambent: 1
)");
}

TEST(ReaderMessages, MissingFileNamesItsNeighbour) {
  const TemporaryDirectory folder;
  write_text(folder.file("bunny.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string text = head + "objects: [{mesh: {file: buny.obj}}]\n";
  const auto errors = errors_of(text, {}, folder.file("scene.yaml"));
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].message, "cannot open '" + folder.file("buny.obj") + "': No such file or directory");
  EXPECT_EQ(errors[0].hint, "did you mean 'bunny.obj'?");
  EXPECT_EQ(errors[0].place.line, 3);
  EXPECT_EQ(errors[0].place.column, 25);
}

TEST(ReaderMessages, ErrorsOfAMeshFileKeepTheirPlace) {
  const TemporaryDirectory folder;
  write_text(folder.file("bad.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  const auto errors = errors_of(head + "objects: [{mesh: {file: bad.obj}}]\n", {}, folder.file("scene.yaml"));
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].place.file, folder.file("bad.obj"));
  EXPECT_EQ(errors[0].place.line, 4);
}

TEST(ReaderMessages, AllErrorsOfAFileInItsOrder) {
  const auto errors = errors_of(R"(lambent: 1
objects:
  - {sphere: {center: [0, 0], radius: 1}}
lights:
  - {point: {position: [0, 0, 0], intensity: -1}}
camera: {eye: [0, 0, 5], target: [0, 0, 0], fov: wide}
image: {size: [0, 100], samples: 1.5}
)");
  std::vector<int> lines;
  for (const Diagnostic& error : errors) lines.push_back(error.place.line);
  EXPECT_EQ(lines, (std::vector<int>{3, 5, 6, 7, 7}));
}

TEST(ReaderMessages, ColumnsCountCharactersAndTheCaretStandsUnderThem) {
  const auto errors = errors_of(head + "materials: [{name: \"\xc3\xa9\xc3\xa9\", diffus: 1}]\n");
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].place.column, 26);
  EXPECT_EQ(errors[0].caret_column, 28);  // bytes, two of which are tails
}

/// The message and the hint of the only error, with a bar between.
std::string only(const std::string& text) {
  const auto errors = errors_of(text);
  if (errors.size() != 1) return std::to_string(errors.size()) + " errors\n" + report(text);
  return errors[0].message + " | " + errors[0].hint;
}

TEST(ReaderMessages, Values) {
  const auto image = [](const std::string& text) { return only(head + "image: {" + text + "}\n"); };
  EXPECT_EQ(image("samples: 1.5"), "'samples' must be a whole number, not '1.5' | ");
  EXPECT_EQ(image("samples: 0"), "'samples' is 0, but must be 1 to 65536 | ");
  EXPECT_EQ(image("samples: {}"),
            "the samples are neither a number nor 'adaptive' | for example samples: {adaptive: {error: 1}}");
  EXPECT_EQ(image("samples: {adaptive: {start: 16, max: 8}}"),
            "at most 8 samples, but 16 to start with | 'max' is at least 'start'");
  EXPECT_EQ(image("samples: 0x10"),
            "'samples' must be a number, not '0x10' | numbers are written in decimals: 16, 0.5, -1e-3");
  EXPECT_EQ(image("samples: 1_000"),
            "'samples' must be a number, not '1_000' | numbers are written in decimals: 16, 0.5, -1e-3");
  EXPECT_EQ(image("samples: \"4\""), "'samples' must be a number, not '4' | remove the quotes");
  EXPECT_EQ(image("samples: !!int 4"), "'samples' has the tag '!!int' | remove it: scene files need no tags");
  EXPECT_EQ(image("samples: 1e999"), "'samples' is '1e999', which is more than a number can hold | ");
  EXPECT_EQ(image("samples:4"),
            "unknown key 'samples:4' in the image | a space belongs behind the colon: 'samples: 4'");
  EXPECT_EQ(image("size: [640]"), "'size' must be [width, height], not a list of 1 | ");
  EXPECT_EQ(image("size: 640x480"), "'size' must be a list, not '640x480' | ");
  EXPECT_EQ(image("size: [640, 70000]"), "the height is 70000, but must be 1 to 65536 | ");
  EXPECT_EQ(image("size: [65536, 65536]"),
            "an image of 65536 by 65536 is too large | 268435456 pixels at most");
  EXPECT_EQ(image("filter: boxx"), "'filter' is 'boxx', which is not known here | did you mean 'box'?");
  const auto whitted = [](const std::string& text) {
    return only(head + "integrator: {whitted: {" + text + "}}\n");
  };
  EXPECT_EQ(whitted("shadows: no"), "'shadows' must be true or false, not 'no' | write false");
  EXPECT_EQ(whitted("shadows: On"), "'shadows' must be true or false, not 'On' | write true");
  EXPECT_EQ(whitted("shadows: \"true\""), "'shadows' must be true or false, not 'true' | remove the quotes");
  const auto illumination = [](const std::string& text) {
    return only(head + "illumination: {" + text + "}\n");
  };
  EXPECT_EQ(illumination("attenuation: 1/R"),
            "'attenuation' is '1/R', which is not known here | did you mean '1/r'?");
  EXPECT_EQ(illumination("attenuation: {linear: 0}"),
            "'constant', 'linear' and 'quadratic' are all 0 | for lights that do not fade write: "
            "attenuation: none");
  EXPECT_EQ(illumination("attenuation: {linear: -1}"), "'linear' is -1, but must be at least 0 | ");
  EXPECT_EQ(
      illumination("ambient: blue"),
      "'ambient' must be a colour, not 'blue' | a colour is [r, g, b], one number for grey, or \"#rrggbb\"");
  EXPECT_EQ(illumination("ambient: \"#12345\""),
            "'ambient' must be a colour, not '#12345' | after # stand six hexadecimal digits: \"#ff8800\"");
  EXPECT_EQ(illumination("minimum_distance: 0"), "'minimum_distance' is 0, but must be positive | ");
  EXPECT_EQ(illumination("minimum_distance: 1e-11"),
            "'minimum_distance' is 1e-11, but must be at least 1e-10 | ");
  EXPECT_EQ(illumination("minimum_distance: 1e11"),
            "'minimum_distance' is 1e11, but must be at most 1e10 | ");
}

TEST(ReaderMessages, Structure) {
  EXPECT_EQ(only(head + "integrator: {}\n"),
            "'integrator' names none | it is one of: whitted, spectral, path, ambient_occlusion, view");
  EXPECT_EQ(only(head + "lights: {}\n"), "'lights' must be a list, not a mapping | ");
  EXPECT_EQ(only(head + "lights: [{name: a}]\n"),
            "this light has no kind | it is one of: " + join(names_of(format().lights)));
  EXPECT_EQ(only(head + "lights: [{point: {position: [0, 1, 0]}, directional: {direction: [0, -1, 0]}}]\n"),
            "'directional' stands beside 'point' | a light is of one kind; make it a second light");
  EXPECT_EQ(
      only(head +
           "lights: [{name: a, point: {position: [0, 1, 0]}}, {name: a, point: {position: [0, 1, 0]}}]\n"),
      "the name 'a' is taken | the first is in line 3; choose another");
  EXPECT_EQ(only(head + "lights: [{spot: {position: [0, 1, 0], target: [0, 1, 0]}}]\n"),
            "'position' and 'target' are the same point | the light shines from one to the other");
  EXPECT_EQ(
      only(head + "lights: [{rectangle: {center: [0, 1, 0], u: [1, 2, 0], v: [-2, -4, 0]}}]\n"),
      "'v' lies along 'u': the light has no area | they are the light's sides; of a rectangle they are at a "
      "right angle");
  EXPECT_EQ(only(head + "lights: [{disc: {center: [0, 1, 0], normal: [0, 1, 0], radius: 0}}]\n"),
            "'radius' is 0, but must be positive | ");
  EXPECT_EQ(only(head + "lights: [{sphere: {center: [0, 1, 0], radius: 1, samples: 0}}]\n"),
            "'samples' is 0, but must be 1 to 1024 | ");
  EXPECT_EQ(only(head + "lights: [{name: far, sphere: {center: [0, 1e10, 0], radius: 1}}]\n"),
            "'far' reaches beyond 1e10 scene units from the origin | choose a larger unit of length: scale "
            "the scene "
            "down");
  EXPECT_EQ(only(head + "lights: [{directional: {direction: [0, 0, 0]}}]\n"),
            "'direction' is [0, 0, 0], which is no direction | a direction may have any length but zero");
  EXPECT_EQ(only(head + "materials: [{name: a}, {name: a}]\n"),
            "the name 'a' is taken | the first is in line 3; choose another");
  EXPECT_EQ(only(head + "materials: [{name: 5}]\n"),
            "'name' must be text, not '5' | put it in quotes: \"5\"");
  EXPECT_EQ(only(head + "objects: [{name: nothing}]\n"),
            "this object has no shape | a shape is one of: sphere, plane, disc, box, cylinder, cone, "
            "polygon, mesh, scene");
  EXPECT_EQ(only(head + "objects: [{mesh: {file: a.stl2}}]\n").substr(0, 45),
            "'a.stl2' is no model file that Lambent reads ");
  EXPECT_EQ(only("lambent: 1\ncamera: {eye: [1, 1, 1], target: [1, 1, 1]}\n"),
            "'eye' and 'target' are the same point | the camera looks from one to the other");
  EXPECT_EQ(only("lambent: 1\ncamera: {eye: [0, 5, 0], target: [0, 0, 0]}\n"),
            "'up' lies along the way from 'eye' to 'target' | to look straight up or down give another 'up', "
            "such as [0, 0, -1]");
  EXPECT_EQ(
      only("- 1\n- 2\n"),
      "the scene must be a mapping, not a list | its keys are: lambent, camera, image, film, illumination, "
      "integrator, background, fog, lights, materials, objects");
  EXPECT_EQ(
      only(head + "---\n" + head),
      "a second YAML document begins here | a scene file holds one; remove the line '---' and what follows");
  EXPECT_EQ(only(std::string("a\0b", 3)),
            "this is not a text file: it holds a byte of value 0 | scene files are UTF-8 text");
  EXPECT_EQ(only(head + "image:\n\tsamples: 1\n").substr(0, 16), "this is not YAML");
  EXPECT_NE(only(head + "image:\n\tsamples: 1\n").find("indent with spaces, not with tabs"),
            std::string::npos);
  EXPECT_EQ(only(head + "image: &a {samples: *a}\n"),
            "this is not YAML: this alias stands inside the value that it names | ");
}

TEST(ReaderMessages, BytesThatAreNotUtf8) {
  // Columns are characters (the umlaut takes two bytes), carets stand under bytes.
  EXPECT_EQ(only(head + "background: \"\xc3\xa4\xff\"\n"),
            "this is not YAML: invalid leading UTF-8 octet | scene files are UTF-8 text");
  EXPECT_EQ(report(head + "background: \"\xc3\xa4\xff\"\n").substr(0, 15), "scene.yaml:3:15");
}

TEST(ReaderMessages, NestedTooDeeply) {
  EXPECT_EQ(only(head + "image: " + std::string(3000, '[')), "the YAML is nested too deeply | ");
}

TEST(ReaderMessages, Shapes) {
  const auto object = [](const std::string& text) { return only(head + "objects: [{" + text + "}]\n"); };
  EXPECT_EQ(object("box: {min: [0, 0, 0], max: [1, -1, 1]}"),
            "y of 'max' is -1, but must be more than 0, that of 'min' | ");
  EXPECT_EQ(object("cylinder: {from: [0, 1, 0], to: [0, 1, 0], radius: 1}"),
            "'from' and 'to' are the same point | ");
  EXPECT_EQ(object("cone: {from: [0, 1, 0], to: [0, 2, 0], radius_from: 0, radius_to: 0}"),
            "'radius_from' and 'radius_to' are both 0 | one of them may be");
  EXPECT_EQ(object("polygon: {vertices: [[0, 0, 0], [1, 0, 0]]}"),
            "a polygon needs 3 vertices at least, not 2 | ");
  EXPECT_EQ(object("polygon: {vertices: [[0, 0, 0], [1, 0, 0], [2, 0, 0]]}"), "this polygon has no area | ");
  EXPECT_EQ(object("polygon: {vertices: [[0, 0, 0], [1, 0, 0], [1, 1, 0.1], [0, 1, 0]]}"),
            "this polygon is not flat: its vertices lie up to 0.018 of its size off their plane | up to 1e-4 "
            "is allowed; for a curved surface use a mesh");
  EXPECT_EQ(object("mesh: {}"), "a mesh needs 'file', or 'vertices' and 'triangles' | ");
  EXPECT_EQ(object("mesh: {vertices: [[0, 0, 0]]}"), "a mesh with 'vertices' needs 'triangles' | ");
  EXPECT_EQ(object("mesh: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles: [[0, 1, 3]]}"),
            "triangle 1 refers to vertex 3, but there are only 3 | indices are 0 to 2");
  EXPECT_EQ(object("mesh: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles: [[0, 1, 2]], normals: "
                   "[[0, 0, 1]]}"),
            "'normals' has 1 elements, but there are 3 vertices | ");
  EXPECT_EQ(object("sphere: {center: [0, 0, 0], radius: 1}, box: {min: [0, 0, 0], max: [1, 1, 1]}"),
            "'box' stands beside 'sphere' | an object is one shape; make it a second object");
  const std::string sphere = "sphere: {center: [0, 0, 0], radius: 1}, ";
  EXPECT_EQ(object(sphere + "transform: {scale: [1, 0, 1]}"),
            "'scale' flattens everything: a factor is 0 | to leave an axis as it is, write 1");
  EXPECT_EQ(object(sphere + "transform: {scale: 2, translate: [1, 0, 0]}"),
            "'translate' stands in one step with 'scale' | steps are elements of a list, because their order "
            "matters: "
            "[{scale: 2}, {translate: [1, 0, 0]}]");
  EXPECT_EQ(object(sphere + "transform: {rotate: {axis: w, degrees: 3}}"),
            "'axis' is 'w', which is not known here | known are: x, y, z");
  EXPECT_EQ(object(sphere + "transform: {matrix: [[1, 0, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0]]}"),
            "'matrix' flattens everything: its determinant is 0 | ");
  EXPECT_EQ(object(sphere + "transform: [{scale: 1e9}, {scale: 1e9}]"),
            "'object 1' reaches beyond 1e10 scene units from the origin | choose a larger unit of length: "
            "scale the scene down");
  EXPECT_EQ(object(sphere + "material: {difuse: 1}"),
            "unknown key 'difuse' in a material | did you mean 'diffuse'?");
  EXPECT_EQ(object(sphere + "material: red"),
            "there is no material 'red' | the scene has no list of materials");
}

TEST(Reader, DeepNestingIsRefused) {
  const auto errors = errors_of(std::string(100000, '['));
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].message, "the YAML is nested too deeply");
}

TEST(Reader, AliasesThatWouldGrowWithoutBoundAreRefusedAtOnce) {
  std::string text = head + "lights: &a0 [x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 60; ++i) {
    const std::string one = "*a" + std::to_string(i - 1);
    text += "k" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + one + "," + one + "," + one + "," +
            one + "]\n";
  }
  EXPECT_FALSE(errors_of(text + "objects: *a59\n").empty());
}

TEST(Reader, ThousandsOfErrorsEndSomewhere) {
  std::string text = head + "objects:\n";
  for (int i = 0; i < 5000; ++i) text += "- {sphere: {center: [0, 0, 0], radius: -1}}\n";
  EXPECT_EQ(errors_of(text).size(), 1000u);
}

TEST(Reader, TakesNumbersInEveryDecimalForm) {
  const auto fov = [](const std::string& text) {
    return parse_scene("lambent: 1\ncamera: {eye: [0, 0, 5], target: [0, 0, 0], fov: " + text + "}\n")
        ->camera.fov;
  };
  EXPECT_EQ(fov("40"), 40.0);
  EXPECT_EQ(fov("+40.0"), 40.0);
  EXPECT_EQ(fov("4e1"), 40.0);
  EXPECT_EQ(fov("400.E-1"), 40.0);
  EXPECT_EQ(fov(".5"), 0.5);
  EXPECT_EQ(fov("0.1"), 0.1);  // correctly rounded
}

TEST(Reader, TakesColoursInThreeForms) {
  const auto background = [](const std::string& text) {
    return parse_scene(head + "background: " + text + "\n")->background;
  };
  EXPECT_EQ(background("[0.1, 0.2, 3]"), (Rgb{{0.1, 0.2, 3}}));
  EXPECT_EQ(background("0.25"), (Rgb{{0.25, 0.25, 0.25}}));
  // IEC 61966-2-1: 0x80 / 255 encoded is ((0.50196 + 0.055) / 1.055)^2.4 = 0.21586 linear.
  const Rgb color = background("\"#FF8000\"");
  EXPECT_EQ(color[0], 1.0);
  EXPECT_NEAR(color[1], 0.215860500113899, 1e-12);
  EXPECT_EQ(color[2], 0.0);
}

TEST(Reader, TakesJsonWithTabsAndEscapes) {
  const ScenePtr scene = parse_scene(
      "{\n\t\"lambent\": 1,\n\t\"camera\": {\n\t\t\"eye\": [0, 0, 5],\n\t\t\"target\": [0, 0, 0]\n\t},\n"
      "\t\"lights\": [{\"name\": \"\\u00e9\\/\\\"\", \"point\": {\"position\": [1.0, 2, 3e0]}}]\n}\n");
  ASSERT_EQ(scene->lights.size(), 1u);
  EXPECT_EQ(scene->lights[0].name, "\xc3\xa9/\"");
}

// JSON has \ud83d\ude00 for U+1F600; libyaml refuses it.
TEST(Reader, TakesJsonThatEscapesCharactersInTwoHalves) {
  const std::string begin = R"({"lambent": 1, "camera": {"eye": [0, 0, 5], "target": [0, 0, 0]},)"
                            "\n";
  const ScenePtr scene =
      parse_scene(begin + R"("materials": [{"name": "\ud83d\ude00\\ud83d\uDBFF\uDFFF \u00e4"}]})");
  ASSERT_EQ(scene->materials.size(), 1u);
  EXPECT_EQ(scene->materials[0].name, "\xf0\x9f\x98\x80\\ud83d\xf4\x8f\xbf\xbf \xc3\xa4");

  // Places are those of the text as it was written.
  const std::string line = R"("materials": [{"name": "\ud83d\ude00\ud83d\ude00", "diffus": 1}]})";
  const auto errors = errors_of(begin + line);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].message, "unknown key 'diffus' in a material");
  EXPECT_EQ(errors[0].place.line, 2);
  EXPECT_EQ(errors[0].place.column, int(line.find("\"diffus\"")) + 1);
  EXPECT_EQ(errors[0].excerpt, line);
}

TEST(ReaderMessages, HalvesOfCharacters) {
  const std::string hint =
      " | a character beyond U+FFFF is written as it is, or as one escape such as \\U0001f600";
  const std::string refused = "this is not YAML: found invalid Unicode character escape code" + hint;
  EXPECT_EQ(only(head + R"(background: "\ud83d\ude00")"), refused);                  // no JSON
  EXPECT_EQ(only(R"({"lambent": 1, "materials": [{"name": "\ud83d"}]})"), refused);  // none either
  EXPECT_EQ(only(R"({"lambent": 1, "materials": [{"name": "\ude00\ud83d"}]})"), refused);
}

TEST(Reader, TakesAnyLineEndAndAByteOrderMark) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const auto errors = errors_of("\xef\xbb\xbflambent: 1" + end +
                                  "camera: {eye: [0, 0, 5], target: [0, 0, 0]}" + end + "foo: 1" + end);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].place.line, 3);
    EXPECT_EQ(errors[0].excerpt, "foo: 1");
  }
}

TEST(Reader, AliasesStandForTheirValue) {
  const ScenePtr scene =
      parse_scene(head + "materials:\n  - {name: a, diffuse: &c [0.1, 0.2, 0.3], specular: *c}\n");
  EXPECT_EQ(scene->materials[0].specular, (Rgb{{0.1, 0.2, 0.3}}));
}

}  // namespace
}  // namespace lambent::test
