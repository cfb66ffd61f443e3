#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "gltf_builder.h"
#include "read_model.h"

namespace lambent {
namespace {

using nlohmann::json;
using test::GltfBuilder, test::Files, test::mesh_of, test::printed, test::Strings, test::warnings_of;

Model read(const std::string& text, const Files& beside = {}, const ImportOptions& options = {},
           const std::string& name = "model.gltf") {
  return test::read_model(import_model, name, text, options, beside);
}
Strings errors_of(const std::string& text, const std::string& name = "model.gltf", const Files& beside = {},
                  const ImportOptions& options = {}) {
  return test::errors_when([&] { read(text, beside, options, name); });
}
bool any_contains(const Strings& lines, const std::string& text) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const auto& line) { return line.find(text) != std::string::npos; });
}

const MaterialMap* map_of(const Material& material, MapSlot slot) {
  for (const MaterialMap& map : material.maps)
    if (map.slot == slot) return &map;
  return nullptr;
}

const std::vector<float> square{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::vector<float> square_uvs{0, 1, 1, 1, 1, 0, 0, 0};  // glTF's v runs downwards
const std::vector<float> up_z{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
const std::vector<std::uint16_t> two_triangles{0, 1, 2, 0, 2, 3};

/// A square in the plane z = 0.
GltfBuilder with_square(const json& more = json::object()) {
  GltfBuilder file;
  json primitive = {{"attributes", {{"POSITION", file.add(square, "VEC3")}}},
                    {"indices", file.add(two_triangles, "SCALAR")}};
  primitive.update(more);
  file.show(primitive);
  return file;
}

// ---- the file

TEST(Gltf, ATriangleWithoutIndices) {
  GltfBuilder file;
  file.show({{"attributes", {{"POSITION", file.add<float>({0, 0, 0, 1.5, 0, 0, 0, 2, -3}, "VEC3")}}}});
  const Model model = read(file.text());
  ASSERT_EQ(model.shapes.size(), 1u);
  EXPECT_EQ(model.shapes[0].name, "mesh 1");
  EXPECT_EQ(mesh_of(model).vertices[1], (Vec3<float>{1.5f, 0, 0}));
  EXPECT_EQ(mesh_of(model).vertices[2], (Vec3<float>{0, 2, -3}));
  EXPECT_TRUE(mesh_of(model).normals.empty());
  ASSERT_EQ(model.objects.size(), 1u);
  EXPECT_TRUE(is_identity(model.objects[0].world_from_object));
  ASSERT_EQ(model.materials.size(), 1u);
  EXPECT_EQ(model.materials[0].name, "default");
  EXPECT_EQ(model.materials[0].metallic_roughness->metallic, 1);
  EXPECT_TRUE(model.materials[0].one_sided);
  EXPECT_EQ(model.illumination, ModelId::blinn_phong);
  EXPECT_FALSE(model.z_up);
  EXPECT_EQ(warnings_of(model), Strings{});
}

TEST(Gltf, AllPackagingsAreTheSame) {
  const GltfBuilder file = with_square();
  GltfBuilder outside = file;
  outside.root["buffers"] = {{{"byteLength", file.bytes().size()}, {"uri", "my%20data.bin"}}};
  const Model a = read(file.text()), b = read(file.binary(), {}, {}, "model.glb"),
              c = read(outside.root.dump(), {{"my data.bin", file.bytes()}});
  for (const Model* model : {&a, &b, &c}) {
    EXPECT_EQ(mesh_of(*model).vertices.size(), 4u);
    EXPECT_EQ(mesh_of(*model).triangles, (decltype(Mesh::triangles){{0, 1, 2}, {0, 2, 3}}));
  }
}

TEST(Gltf, BuffersThatAreMissingOrShortOrOutside) {
  GltfBuilder file = with_square();
  const std::string size = std::to_string(file.bytes().size());
  file.root["buffers"] = {{{"byteLength", file.bytes().size()}, {"uri", "a.bin"}}};
  EXPECT_EQ(errors_of(file.root.dump()),
            (Strings{"model.gltf: error: /buffers/0: there is no file 'a.bin'"}));
  EXPECT_EQ(errors_of(file.root.dump(), "model.gltf", {{"a.bin", "abc"}}),
            (Strings{"model.gltf: error: /buffers/0: is to have " + size + " bytes, but there are only 3"}));
  const test::TemporaryDirectory elsewhere;
  test::write_text(elsewhere.file("a.bin"), file.bytes());
  file.root["buffers"][0]["uri"] = elsewhere.file("a.bin");
  EXPECT_TRUE(any_contains(errors_of(file.root.dump()),
                           "lies outside of the model's folder\n"
                           "    hint: --allow-outside lets files name files that lie elsewhere"));
  ImportOptions anywhere;
  anywhere.limits.allow_outside = true;
  EXPECT_EQ(errors_of(file.root.dump(), "model.gltf", {}, anywhere), Strings{});
  // Without a uri the specification leaves open where the bytes come from.
  file.root["buffers"][0].erase("uri");
  EXPECT_TRUE(any_contains(warnings_of(read(file.root.dump())), "its buffer has no uri"));
}

TEST(Gltf, MalformedJsonHasItsPlace) {
  EXPECT_EQ(
      errors_of("{\n  \"asset\": {\"version\" \"2.0\"}\n}"),
      (Strings{"model.gltf:2:23: error: the JSON is malformed: syntax error while parsing object separator - "
               "unexpected string literal; expected ':'\n"
               "      \"asset\": {\"version\" \"2.0\"}\n                          ^"}));
  EXPECT_TRUE(any_contains(errors_of("\xef\xbb\xbf{}"), "byte order mark"));
  EXPECT_TRUE(any_contains(errors_of(""), "malformed"));
  EXPECT_EQ(errors_of(R"({"asset": {"version": "2.0", "version": "2.0"}})"),
            (Strings{"model.gltf: error: /asset: the key 'version' stands twice in one object"}));
  EXPECT_TRUE(any_contains(errors_of(R"({"asset": {"version": "2.0"}, "extras": 1e999})"), "malformed"));
  const std::string deep = R"({"asset": {"version": "2.0"}, "extras": )";
  EXPECT_TRUE(
      any_contains(errors_of(deep + std::string(100000, '[') + std::string(100000, ']') + "}"), "nested"));
  EXPECT_EQ(errors_of(deep + std::string(100, '[') + std::string(100, ']') + "}"), Strings{});
}

TEST(Gltf, DamagedContainers) {
  const std::string good = with_square().binary();
  const auto fails = [&](std::string bytes, const char* why) {
    EXPECT_TRUE(any_contains(errors_of(bytes, "model.glb"), why)) << why;
  };
  fails("", "ends within its header");
  fails("glTF\2", "ends within its header");
  fails("xlTF" + good.substr(4), "must begin with 'glTF'");
  fails(good.substr(0, 4) + '\1' + good.substr(5), "byte 4: the container's version is 1");
  fails(good + "1234", "the header says");
  fails(good.substr(0, good.size() - 4), "the header says");
  std::string far_too_long = good;
  far_too_long[14] = '\x7f';
  fails(far_too_long, "byte 12: the chunk is to have");
  for (std::size_t size = 0; size < good.size(); size += 7)
    EXPECT_FALSE(errors_of(good.substr(0, size), "model.glb").empty());
}

// ---- what is wrong is said, with its place

TEST(Gltf, TheSchemaIsChecked) {
  EXPECT_EQ(errors_of("[]"), (Strings{"model.gltf: error: must be an object, not a list"}));
  EXPECT_EQ(errors_of("{}"), (Strings{"model.gltf: error: needs 'asset'"}));
  EXPECT_EQ(errors_of(R"({"asset": {"version": "3.1"}})"),
            (Strings{"model.gltf: error: /asset/version: glTF '3.1' is not supported, only 2.0"}));
  GltfBuilder file = with_square();
  file.root["nodes"][0]["mesh"] = 7;
  file.root["meshes"][0]["primitives"][0]["mode"] = 9;
  file.root["accessors"][0]["componentType"] = 5124;
  file.root["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 1.5}}}, {"alphaMode", "MASKED"}}};
  file.root["scenes"][0]["nodes"] = json::array();
  EXPECT_EQ(
      errors_of(file.text()),
      (Strings{"model.gltf: error: /accessors/0/componentType: 5124 is not known\n"
               "    hint: one of: 5120 5121 5122 5123 5125 5126",
               "model.gltf: error: /materials/0/pbrMetallicRoughness/metallicFactor: 1.5 is out of range",
               "model.gltf: error: /materials/0/alphaMode: 'MASKED' is not known\n    hint: one of: OPAQUE "
               "MASK BLEND",
               "model.gltf: error: /meshes/0/primitives/0/mode: 9 is out of range",
               "model.gltf: error: /nodes/0/mesh: there is no /meshes/7: the list has 1",
               "model.gltf: error: /scenes/0/nodes: must have at least one element, not 0"}));
}

TEST(Gltf, TheRulesAreChecked) {
  // Each: what is changed, and what must then be said.
  const auto fails = [](const char* pointer, const json& value, const std::string& why) {
    GltfBuilder file = with_square();
    file.root[json::json_pointer(pointer)] = value;
    const Strings errors = errors_of(file.text());
    EXPECT_TRUE(any_contains(errors, why)) << why << "\n" << (errors.empty() ? "no error" : errors[0]);
  };
  fails("/accessors/0/count", 5,
        "/accessors/0: 5 elements from byte 0 on do not fit into the bufferView's 48 bytes");
  fails("/accessors/0/byteOffset", 2, "/accessors/0: its first byte must be a multiple of 4");
  fails("/accessors/0/min", {0, 0}, "/accessors/0/min: must have 3 elements");
  fails("/accessors/0/max", {2, 1, 0}, "/accessors/0/max/0: is 2.0, but the elements have 1.0");
  fails("/accessors/0/normalized", true, "/accessors/0/normalized: only bytes and shorts");
  fails("/bufferViews/0/byteStride", 4, "more than the byteStride 4");
  fails("/bufferViews/1/byteLength", 1000, "/bufferViews/1: its bytes 48 to 1048 do not fit");
  fails("/meshes/0/primitives/0/indices", 0,
        "/meshes/0/primitives/0/indices: its accessor must not be VEC3 of FLOAT");
  fails("/meshes/0/primitives/0/attributes/COLOR", 0, "'COLOR' is no attribute of glTF");
  fails("/meshes/0/primitives/0/attributes/TEXCOORD_1", 0, "TEXCOORD_0 to _1 must all be there");
  fails("/meshes/0/weights", {1}, "/meshes/0/weights: has 1 elements for 0 morph targets");
  fails("/nodes/0/children", {0}, "/nodes/0: is its own descendant");
  fails("/nodes/0/rotation", {1, 1, 0, 0}, "/nodes/0/rotation: is no unit quaternion");
  fails("/nodes/0/weights", {1}, "/nodes/0/weights");
  fails("/nodes/0/matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2}, "its last row must be 0 0 0 1");
  fails("/nodes", {{{"children", {2}}}, {{"children", {2}}}, json::object()},
        "node 2 is already a child of node 0");
  fails("/extensionsRequired", {"KHR_draco_mesh_compression"},
        "'KHR_draco_mesh_compression', which is not supported");
  fails("/nodes/0/extensions", {{"KHR_lights_punctual", {{"light", 0}}}}, "the extension is not declared");
  fails("/cameras", {{{"type", "perspective"}}}, "/cameras/0: needs 'perspective'");
  fails("/images", json::array({json::object()}), "/images/0: needs either 'uri' or 'bufferView'");
  fails("/skins", {{{"joints", {0, 0}}}}, "/skins/0/joints/1: 0 stands twice");
}

TEST(Gltf, NumbersAreChecked) {
  GltfBuilder range;
  range.show({{"attributes", {{"POSITION", range.add(square, "VEC3")}}},
              {"indices", range.add<std::uint16_t>({0, 1, 4}, "SCALAR")}});
  EXPECT_EQ(errors_of(range.text()), (Strings{"model.gltf: error: /meshes/0/primitives/0/indices: the "
                                              "largest index is 4, but there are 4 vertices"}));
  GltfBuilder infinite;
  infinite.show({{"attributes",
                  {{"POSITION", infinite.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3")},
                   {"NORMAL", infinite.add<float>({0, 0, 1, 0, 0, 1, 0, 0, INFINITY}, "VEC3")}}}});
  infinite.root["accessors"][1].erase("min");
  infinite.root["accessors"][1].erase("max");
  EXPECT_EQ(errors_of(infinite.text()),
            (Strings{"model.gltf: error: /accessors/1: element 2 is not a finite number"}));
}

TEST(Gltf, WhatIsOnlyUsedIsAWarning) {
  GltfBuilder file = with_square();
  file.root["extensionsUsed"] = {"VENDOR_glitter"};
  file.root["meshes"][0]["extensions"] = {{"VENDOR_glitter", {{"much", true}}}};
  EXPECT_EQ(
      warnings_of(read(file.text())),
      (Strings{"model.gltf: warning: /extensionsUsed/0: the extension 'VENDOR_glitter' is not supported; the "
               "file is shown without it"}));
}

TEST(Gltf, LimitsHoldBeforeMemoryIsTaken) {
  ImportOptions options;
  options.limits.primitives = 1;
  EXPECT_TRUE(
      any_contains(errors_of(with_square().text(), "model.gltf", {}, options), "more than 1 primitives"));
  options = {};
  options.limits.file_bytes = 100;
  EXPECT_TRUE(any_contains(errors_of(with_square().text(), "model.gltf", {}, options), "the limit is 100"));
  // Zeroes that cost the file nothing.
  GltfBuilder zeroes;
  zeroes.root["accessors"] = {{{"componentType", 5126},
                               {"count", 4000000000u},
                               {"type", "VEC3"},
                               {"min", {0, 0, 0}},
                               {"max", {0, 0, 0}}}};
  zeroes.show({{"attributes", {{"POSITION", 0}}}});
  EXPECT_TRUE(any_contains(errors_of(zeroes.text()), "more than the file has bytes"));
  // The same bytes again and again.
  GltfBuilder again = with_square();
  for (int i = 0; i < 3000; ++i)
    again.root["accessors"].push_back(
        {{"componentType", 5121}, {"count", 60}, {"type", "SCALAR"}, {"bufferView", 0}});
  EXPECT_TRUE(any_contains(errors_of(again.text()), "do not fit"));
  for (int i = 2; i < 3002; ++i) again.root["accessors"][std::size_t(i)]["count"] = 48;
  EXPECT_EQ(errors_of(again.text()), Strings{});  // the list itself is large enough
}

// ---- geometry

TEST(Gltf, EveryModeOfPrimitives) {
  const auto shape = [](int mode, bool with_indices) {
    GltfBuilder file;
    json primitive = {{"attributes", {{"POSITION", file.add(square, "VEC3")}}}, {"mode", mode}};
    if (with_indices) primitive["indices"] = file.add<std::uint8_t>({0, 1, 2, 3}, "SCALAR");
    file.show(primitive);
    const Model model = read(file.text());
    EXPECT_EQ(warnings_of(model), Strings{});
    return model.shapes.at(0);
  };
  for (const bool indices : {false, true}) {
    const auto points = std::get<std::vector<Sphere>>(shape(0, indices).primitives);
    ASSERT_EQ(points.size(), 4u);
    EXPECT_EQ(points[2].center, (Vec3<double>{1, 1, 0}));
    EXPECT_DOUBLE_EQ(points[0].radius, std::sqrt(2) / 400);
    EXPECT_EQ(std::get<std::vector<Cone>>(shape(1, indices).primitives).size(), 2u);
    const auto loop = std::get<std::vector<Cone>>(shape(2, indices).primitives);
    ASSERT_EQ(loop.size(), 4u);
    EXPECT_EQ(loop[3].from, (Vec3<double>{0, 1, 0}));
    EXPECT_EQ(loop[3].to, (Vec3<double>{0, 0, 0}));
    EXPECT_EQ(loop[3].radius_from, loop[3].radius_to);
    EXPECT_EQ(std::get<std::vector<Cone>>(shape(3, indices).primitives).size(), 3u);
    EXPECT_EQ(std::get<Mesh>(shape(4, indices).primitives).triangles.size(), 1u);
    EXPECT_EQ(std::get<Mesh>(shape(5, indices).primitives).triangles,
              (decltype(Mesh::triangles){{0, 1, 2}, {1, 3, 2}}));
    EXPECT_EQ(std::get<Mesh>(shape(6, indices).primitives).triangles,
              (decltype(Mesh::triangles){{1, 2, 0}, {2, 3, 0}}));
  }
}

TEST(Gltf, PointsKeepTheirSizeInTheWorld) {
  GltfBuilder file;
  file.show({{"attributes", {{"POSITION", file.add(square, "VEC3")}}}, {"mode", 0}});
  file.root["nodes"][0]["scale"] = {10, 10, 10};
  const Model model = read(file.text());
  EXPECT_NEAR(std::get<std::vector<Sphere>>(model.shapes.at(0).primitives)[0].radius, std::sqrt(2) / 400,
              1e-12);
}

TEST(Gltf, PointsAndLinesHaveTheColorsOfTheirVertices) {
  GltfBuilder file;
  const std::size_t positions = file.add(square, "VEC3");
  const std::size_t colors = file.add<std::uint8_t>(
      {255, 0, 0, 255, 0, 255, 0, 255, 255, 0, 0, 255, 255, 255, 255, 255}, "VEC4", true);
  file.show({{"attributes", {{"POSITION", positions}, {"COLOR_0", colors}}}, {"mode", 0}});
  const Model model = read(file.text());
  const auto& materials = model.shapes.at(0).material_of_primitive;
  ASSERT_EQ(materials.size(), 4u);
  EXPECT_EQ(materials[0], materials[2]);
  EXPECT_EQ(model.materials.at(materials[0]).metallic_roughness->base_color, (Rgb{{1, 0, 0}}));
  EXPECT_EQ(model.materials.at(materials[1]).metallic_roughness->base_color, (Rgb{{0, 1, 0}}));
  EXPECT_EQ(model.materials.at(materials[3]).name, "default");
}

TEST(Gltf, PrimitivesTakeOnlyTheVerticesThatTheyHave) {
  GltfBuilder file;
  file.show({{"attributes", {{"POSITION", file.add(square, "VEC3")}}},
             {"indices", file.add<std::uint32_t>({1, 2, 3, 3, 3, 1}, "SCALAR")}});
  const Model model = read(file.text());
  EXPECT_EQ(mesh_of(model).vertices.size(), 3u);
  EXPECT_EQ(mesh_of(model).triangles, (decltype(Mesh::triangles){{0, 1, 2}}));
  EXPECT_EQ(mesh_of(model).vertices[0], (Vec3<float>{1, 0, 0}));
}

TEST(Gltf, AttributesOfVertices) {
  GltfBuilder file;
  file.show(
      {{"attributes",
        {{"POSITION", file.add(square, "VEC3")},
         {"NORMAL", file.add<float>({0, 0, 2, 0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC3")},
         {"TEXCOORD_0", file.add(square_uvs, "VEC2")},
         {"TEXCOORD_1", file.add<std::uint16_t>({0, 0, 65535, 0, 65535, 65535, 0, 13107}, "VEC2", true)},
         {"COLOR_0", file.add<std::uint8_t>({255, 0, 51, 51, 255, 255, 255, 255, 0, 0, 0, 0, 1, 2, 3, 4},
                                            "VEC4", true)}}},
       {"indices", file.add(two_triangles, "SCALAR")},
       {"material", 0}});
  file.root["materials"] = {{{"alphaMode", "BLEND"}}};
  const Model model = read(file.text());
  const Mesh& mesh = mesh_of(model);
  EXPECT_EQ(mesh.normals[0], (Vec3<float>{0, 0, 1}));  // brought to length 1
  EXPECT_EQ(mesh.normals[3], (Vec3<float>{0, 0, 0}));  // the face's own
  EXPECT_TRUE(
      any_contains(warnings_of(model), "/meshes/0/primitives/0/attributes/NORMAL: not all are of length 1"));
  EXPECT_EQ(mesh.uvs[0].y, 0.f);  // (0, 1) is the lower left corner
  EXPECT_EQ(mesh.uvs[2].y, 1.f);
  EXPECT_NEAR(mesh.uvs2[3].y, 0.8f, 1e-6);
  EXPECT_EQ(mesh.colors[0], (std::array<float, 4>{1, 0, 0.2f, 0.2f}));
  file.root["materials"][0].erase("alphaMode");
  EXPECT_EQ(mesh_of(read(file.text())).colors[0], (std::array<float, 4>{1, 0, 0.2f, 1}));  // opaque
}

TEST(Gltf, InterleavedAndSparse) {
  GltfBuilder file;
  // Positions and something else, one behind the other.
  const std::size_t both = file.add<float>({0, 0, 0, 7, 1, 0, 0, 7, 0, 1, 0, 7}, "VEC4");
  file.root["bufferViews"][0]["byteStride"] = 16;
  file.root["accessors"][both] = {{"bufferView", 0}, {"componentType", 5126}, {"count", 3},
                                  {"type", "VEC3"},  {"min", {0, 0, 0}},      {"max", {1, 1, 0}}};
  // The same with the second vertex replaced; and one that is nothing but replacements.
  file.add<std::uint8_t>({1, 2}, "SCALAR");
  file.add<float>({5, 0, 0, 0, 6, 0}, "VEC3");
  const json sparse = {{"count", 2},
                       {"indices", {{"bufferView", 1}, {"componentType", 5121}}},
                       {"values", {{"bufferView", 2}}}};
  for (const bool based : {true, false}) {
    json accessor = {{"componentType", 5126}, {"count", 3},       {"type", "VEC3"},
                     {"min", {0, 0, 0}},      {"max", {5, 6, 0}}, {"sparse", sparse}};
    if (based) accessor["bufferView"] = 0;
    file.root["accessors"].push_back(accessor);
    file.show({{"attributes", {{"POSITION", file.root["accessors"].size() - 1}}}});
  }
  file.show({{"attributes", {{"POSITION", both}}}});
  const Model model = read(file.text());
  for (const std::size_t shape : {0u, 1u}) {
    EXPECT_EQ(mesh_of(model, shape).vertices[0], (Vec3<float>{0, 0, 0}));
    EXPECT_EQ(mesh_of(model, shape).vertices[1], (Vec3<float>{5, 0, 0}));
    EXPECT_EQ(mesh_of(model, shape).vertices[2], (Vec3<float>{0, 6, 0}));
  }
  EXPECT_EQ(mesh_of(model, 2).vertices[1], (Vec3<float>{1, 0, 0}));
}

TEST(Gltf, QuantizedMeshes) {
  GltfBuilder file;
  const std::size_t positions =
      file.add<std::int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, 0, -32768, 0, 0}, "VEC4", true);
  file.root["bufferViews"][0]["byteStride"] = 8;
  file.root["accessors"][positions]["type"] = "VEC3";
  file.root["accessors"][positions]["min"] = {0, -32768, 0};
  file.root["accessors"][positions]["max"] = {32767, 0, 0};
  file.show({{"attributes", {{"POSITION", positions}}}});
  EXPECT_TRUE(any_contains(errors_of(file.text()), "its accessor must not be VEC3 of normalized SHORT"));
  file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  const Model model = read(file.text());
  EXPECT_EQ(mesh_of(model).vertices[1], (Vec3<float>{1, 0, 0}));
  EXPECT_EQ(mesh_of(model).vertices[2], (Vec3<float>{0, -1, 0}));  // the lowest counts as -1
}

// ---- tangents

const Texture& texture_of(const Model& model, const MaterialMap& map) {
  return model.textures.at(map.map.texture);
}
const std::string image_uri = "data:image/png;base64," + test::base64("\x89PNG\r\n\x1a\n");

/// The square with a normal map.
GltfBuilder with_normal_map(const std::vector<float>& uvs) {
  GltfBuilder file;
  file.show({{"attributes",
              {{"POSITION", file.add(square, "VEC3")},
               {"NORMAL", file.add(up_z, "VEC3")},
               {"TEXCOORD_0", file.add(uvs, "VEC2")}}},
             {"indices", file.add(two_triangles, "SCALAR")},
             {"material", 0}});
  file.root["materials"] = {{{"normalTexture", {{"index", 0}, {"scale", 0.5}}}}};
  file.root["textures"] = {{{"source", 0}}};
  file.root["images"] = {{{"uri", image_uri}}};
  return file;
}

TEST(Gltf, TangentsPointAlongTheImage) {
  // The image upright: u along x, its upper edge at y = 1.
  const Model upright = read(with_normal_map(square_uvs).text());
  ASSERT_EQ(mesh_of(upright).tangents.size(), 4u);
  EXPECT_EQ(mesh_of(upright).tangents[0], (std::array<float, 4>{1, 0, 0, 1}));
  const MaterialMap* normal = map_of(upright.materials[0], MapSlot::normal);
  ASSERT_TRUE(normal);
  EXPECT_EQ(normal->map.strength, 0.5);
  EXPECT_FALSE(texture_of(upright, *normal).srgb);
  // Upside down: the upper edge at y = 0.
  const Model mirrored = read(with_normal_map({0, 0, 1, 0, 1, 1, 0, 1}).text());
  EXPECT_EQ(mesh_of(mirrored).tangents[0], (std::array<float, 4>{1, 0, 0, -1}));
}

TEST(Gltf, TangentsOfTheFileAreTaken) {
  GltfBuilder file = with_normal_map(square_uvs);
  file.root["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
      file.add<float>({0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1}, "VEC4");
  EXPECT_EQ(mesh_of(read(file.text())).tangents[2], (std::array<float, 4>{0, 1, 0, -1}));
  // Without normals they mean nothing.
  file.root["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
  EXPECT_TRUE(mesh_of(read(file.text())).tangents.empty());
}

// ---- materials

TEST(Gltf, AMaterialOfMetalAndRoughness) {
  GltfBuilder file = with_square({{"material", 0}});
  file.root["materials"] = json::parse(R"([{
    "name": "paint", "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.25, "emissiveFactor": [0.5, 0.25, 0],
    "emissiveTexture": {"index": 0},
    "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.6,
      "baseColorTexture": {"index": 0, "texCoord": 1}, "metallicRoughnessTexture": {"index": 1}},
    "occlusionTexture": {"index": 1, "strength": 0.75}}, {"name": "paint"}, {}])");
  file.root["textures"] = json::parse(R"([{"source": 0, "sampler": 0}, {"source": 1}])");
  file.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
  file.root["images"] = {{{"uri", image_uri}}, {{"uri", image_uri}}};
  const Model model = read(file.text());
  ASSERT_EQ(model.materials.size(), 3u);
  EXPECT_EQ(model.materials[1].name, "paint 2");
  EXPECT_EQ(model.materials[2].name, "material 3");
  const Material& paint = model.materials[0];
  EXPECT_FALSE(paint.one_sided);
  EXPECT_EQ(paint.alpha, Alpha::mask);
  EXPECT_EQ(paint.alpha_cutoff, 0.25);
  EXPECT_EQ(paint.opacity, 0.4);
  EXPECT_EQ(paint.emission, (Rgb{{0.5, 0.25, 0}}));
  EXPECT_EQ(paint.metallic_roughness->base_color, (Rgb{{0.1, 0.2, 0.3}}));
  EXPECT_EQ(paint.metallic_roughness->metallic, 0.5);
  EXPECT_EQ(paint.metallic_roughness->roughness, 0.6);
  const MaterialMap *base = map_of(paint, MapSlot::base_color), *opacity = map_of(paint, MapSlot::opacity),
                    *metallic = map_of(paint, MapSlot::metallic),
                    *roughness = map_of(paint, MapSlot::roughness),
                    *occlusion = map_of(paint, MapSlot::occlusion),
                    *emission = map_of(paint, MapSlot::emission);
  ASSERT_TRUE(base && opacity && metallic && roughness && occlusion && emission);
  EXPECT_EQ(base->map.uv_set, 1);
  EXPECT_EQ(base->map.wrap_u, Wrap::clamp);
  EXPECT_EQ(base->map.wrap_v, Wrap::mirror);
  EXPECT_TRUE(base->map.nearest);
  EXPECT_TRUE(texture_of(model, *base).srgb);
  EXPECT_EQ(emission->map.texture, base->map.texture);
  EXPECT_FALSE(texture_of(model, *opacity).srgb);
  EXPECT_EQ(opacity->map.channel, 3);
  EXPECT_EQ(metallic->map.channel, 2);
  EXPECT_EQ(roughness->map.channel, 1);
  EXPECT_EQ(occlusion->map.channel, 0);
  EXPECT_EQ(occlusion->map.strength, 0.75);
  EXPECT_EQ(metallic->map.texture, occlusion->map.texture);
  EXPECT_EQ(model.textures.size(), 3u);  // one image as colours and as data, the other as data
  EXPECT_EQ(texture_of(model, *base).source.name, "image 0 of model.gltf");
}

TEST(Gltf, OpaqueMaterialsHaveNoAlpha) {
  GltfBuilder file = with_square({{"material", 0}});
  file.root["materials"] = {{{"pbrMetallicRoughness",
                              {{"baseColorFactor", {1, 1, 1, 0.5}}, {"baseColorTexture", {{"index", 0}}}}}}};
  file.root["textures"] = {{{"source", 0}}};
  file.root["images"] = {{{"uri", image_uri}}};
  const Model model = read(file.text());
  EXPECT_EQ(model.materials[0].opacity, 1);
  EXPECT_FALSE(map_of(model.materials[0], MapSlot::opacity));
}

TEST(Gltf, ImagesThatAreMissing) {
  GltfBuilder file = with_square({{"material", 0}});
  file.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  file.root["textures"] = {{{"source", 0}}};
  file.root["images"] = {{{"uri", "no%20such.png"}}};
  const Model model = read(file.text());
  EXPECT_TRUE(model.textures.empty());
  EXPECT_TRUE(model.materials[0].maps.empty());
  EXPECT_EQ(warnings_of(model), (Strings{"model.gltf: warning: /images/0/uri: 'no such.png' is not there; "
                                         "the surfaces are shown without it"}));
  const Model there = read(file.text(), {{"no such.png", "\x89PNG\r\n\x1a\n"}});
  ASSERT_EQ(there.textures.size(), 1u);
  EXPECT_TRUE(there.textures[0].source.file.ends_with("no such.png"));
}

TEST(Gltf, ExtensionsOfMaterials) {
  GltfBuilder file = with_square({{"material", 0}});
  file.root["materials"] = json::parse(R"([{"emissiveFactor": [1, 0.5, 0], "extensions": {
    "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 2, 3], "specularTexture": {"index": 0},
      "specularColorTexture": {"index": 0}},
    "KHR_materials_ior": {"ior": 1.33}, "KHR_materials_transmission": {"transmissionFactor": 0.75, "transmissionTexture": {"index": 0}},
    "KHR_materials_emissive_strength": {"emissiveStrength": 8},
    "KHR_materials_clearcoat": {"clearcoatFactor": 0.25, "clearcoatRoughnessFactor": 0.125, "clearcoatTexture": {"index": 0},
      "clearcoatRoughnessTexture": {"index": 0}}}}])");
  for (const auto& [name, value] : file.root["materials"][0]["extensions"].items())
    file.root["extensionsUsed"].push_back(name);
  file.root["textures"] = {{{"source", 0}}};
  file.root["images"] = {{{"uri", image_uri}}};
  const Model model = read(file.text());
  const Material& material = model.materials[0];
  const MetallicRoughness& settings = *material.metallic_roughness;
  EXPECT_EQ(material.emission, (Rgb{{8, 4, 0}}));
  EXPECT_EQ(settings.specular, 0.5);
  EXPECT_EQ(settings.specular_color, (Rgb{{1, 2, 3}}));
  EXPECT_EQ(settings.ior, 1.33);
  EXPECT_EQ(settings.transmission, 0.75);
  EXPECT_EQ(settings.clearcoat, 0.25);
  EXPECT_EQ(settings.clearcoat_roughness, 0.125);
  EXPECT_EQ(map_of(material, MapSlot::specular_factor)->map.channel, 3);
  EXPECT_TRUE(texture_of(model, *map_of(material, MapSlot::specular_color)).srgb);
  EXPECT_EQ(map_of(material, MapSlot::transmission)->map.channel, 0);
  EXPECT_EQ(map_of(material, MapSlot::clearcoat)->map.channel, 0);
  EXPECT_EQ(map_of(material, MapSlot::clearcoat_roughness)->map.channel, 1);
}

TEST(Gltf, UnlitMaterialsGlow) {
  GltfBuilder file;
  file.show({{"attributes",
              {{"POSITION", file.add(square, "VEC3")},
               {"COLOR_0", file.add<float>({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3")}}},
             {"indices", file.add(two_triangles, "SCALAR")},
             {"material", 0}});
  file.root["extensionsUsed"] = {"KHR_materials_unlit"};
  file.root["materials"] = {{{"extensions", {{"KHR_materials_unlit", json::object()}}},
                             {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 1, 1}}}}}};
  const Model model = read(file.text());
  EXPECT_FALSE(model.materials[0].metallic_roughness);
  EXPECT_EQ(model.materials[0].emission, (Rgb{{0.5, 0.25, 1}}));
  EXPECT_EQ(model.materials[0].diffuse, (Rgb{{0, 0, 0}}));
  EXPECT_EQ(model.materials[0].ambient, (Rgb{{0, 0, 0}}));
  ASSERT_EQ(model.shapes[0].material_of_primitive.size(), 2u);
  EXPECT_EQ(model.materials.at(model.shapes[0].material_of_primitive[1]).emission, (Rgb{{0.5, 0, 0}}));
}

TEST(Gltf, GlossyMaterialsReflectAsTheySay) {
  GltfBuilder file = with_square({{"material", 0}});
  file.root["extensionsUsed"] = {"KHR_materials_pbrSpecularGlossiness"};
  file.root["materials"] = json::parse(R"([{"extensions": {"KHR_materials_pbrSpecularGlossiness":
    {"diffuseFactor": [0.1, 0.2, 0.3, 1], "specularFactor": [0.2, 0.1, 0.04], "glossinessFactor": 0.75,
     "specularGlossinessTexture": {"index": 0}}}}])");
  file.root["textures"] = {{{"source", 0}}};
  file.root["images"] = {{{"uri", image_uri}}};
  const Model model = read(file.text());
  const MetallicRoughness& settings = *model.materials[0].metallic_roughness;
  EXPECT_EQ(settings.metallic, 0);
  EXPECT_EQ(settings.base_color, (Rgb{{0.1, 0.2, 0.3}}));
  EXPECT_NEAR(0.04 * settings.specular_color[0], 0.2, 1e-12);
  const MaterialMap* roughness = map_of(model.materials[0], MapSlot::roughness);
  ASSERT_TRUE(roughness);
  // roughness = 1 - glossiness * alpha
  EXPECT_EQ(settings.roughness * (roughness->map.offset + roughness->map.gain * 0.5), 1 - 0.75 * 0.5);
}

TEST(Gltf, TransformsOfTexturesHaveVUpwards) {
  GltfBuilder file = with_square({{"material", 0}});
  file.root["extensionsUsed"] = {"KHR_texture_transform"};
  const double angle = 0.3, ox = 0.1, oy = 0.2, sx = 2, sy = 3;
  file.root["materials"] = {
      {{"emissiveFactor", {1, 1, 1}},
       {"emissiveTexture",
        {{"index", 0},
         {"extensions",
          {{"KHR_texture_transform",
            {{"offset", {ox, oy}}, {"rotation", angle}, {"scale", {sx, sy}}, {"texCoord", 1}}}}}}}}};
  file.root["textures"] = {{{"source", 0}}};
  file.root["images"] = {{{"uri", image_uri}}};
  const Model model = read(file.text());
  const TextureMap& map = map_of(model.materials[0], MapSlot::emission)->map;
  EXPECT_EQ(map.uv_set, 1);
  const double u = 0.4, v = 0.7;  // theirs
  const double theirs_u = std::cos(angle) * sx * u + std::sin(angle) * sy * v + ox,
               theirs_v = -std::sin(angle) * sx * u + std::cos(angle) * sy * v + oy;
  EXPECT_NEAR(map.matrix[0] * u + map.matrix[1] * (1 - v) + map.matrix[2], theirs_u, 1e-12);
  EXPECT_NEAR(map.matrix[3] * u + map.matrix[4] * (1 - v) + map.matrix[5], 1 - theirs_v, 1e-12);
}

// ---- the scene

TEST(Gltf, NodesAreATreeOfTransforms) {
  GltfBuilder file = with_square();
  file.root["nodes"] = json::parse(R"([
    {"name": "parent", "translation": [1, 2, 3], "rotation": [0, 0, 0.70710678118654752, 0.70710678118654752], "scale": [2, 2, 2],
     "children": [1, 2]},
    {"name": "child", "mesh": 0, "translation": [1, 0, 0]},
    {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]}, {"mesh": 0, "name": "not in the scene"}])");
  const Model model = read(file.text());
  EXPECT_EQ(model.shapes.size(), 1u);  // stored once
  ASSERT_EQ(model.objects.size(), 2u);
  EXPECT_EQ(model.objects[0].name, "child");
  EXPECT_EQ(model.objects[1].name, "mesh 1");
  // (1, 0, 0) in the child is (2, 0, 0) in the parent, twice that turned to +y, moved.
  const Vec3<double> p = transform_point(model.objects[0].world_from_object, {1, 0, 0});
  EXPECT_NEAR(p.x, 1, 1e-12);
  EXPECT_NEAR(p.y, 6, 1e-12);
  EXPECT_NEAR(p.z, 3, 1e-12);
  EXPECT_NEAR(transform_point(model.objects[1].world_from_object, {0, 0, 0}).y, 2 + 2 * 5, 1e-12);
}

TEST(Gltf, WhichSceneIsShown) {
  GltfBuilder file = with_square();
  file.root["nodes"] = {{{"mesh", 0}, {"name", "a"}}, {{"mesh", 0}, {"name", "b"}}};
  file.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  file.root["scene"] = 1;
  EXPECT_EQ(read(file.text()).objects.at(0).name, "b");
  file.root.erase("scene");
  const Model first = read(file.text());
  EXPECT_EQ(first.objects.at(0).name, "a");
  EXPECT_TRUE(any_contains(warnings_of(first), "does not say which of its 2 scenes"));
  file.root.erase("scenes");
  EXPECT_EQ(read(file.text()).objects.size(), 2u);
  file.root.erase("nodes");
  const Model library = read(file.text());
  EXPECT_EQ(library.objects.size(), 1u);
  EXPECT_TRUE(any_contains(warnings_of(library), "the file has no scene; all of its meshes are shown"));
}

TEST(Gltf, WhatIsScaledToNothingIsLeftOut) {
  GltfBuilder file = with_square();
  file.root["nodes"][0]["scale"] = {0, 0, 0};
  const Model model = read(file.text());
  EXPECT_TRUE(model.objects.empty());
  EXPECT_TRUE(any_contains(warnings_of(model), "/nodes/0: its transform leaves nothing of a volume"));
}

TEST(Gltf, InvisibleNodes) {
  GltfBuilder file = with_square();
  file.root["extensionsUsed"] = {"KHR_node_visibility"};
  file.root["nodes"] = {{{"mesh", 0}},
                        {{"children", {2}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}},
                        {{"mesh", 0}}};
  file.root["scenes"][0]["nodes"] = {0, 1};
  EXPECT_EQ(read(file.text()).objects.size(), 1u);
}

TEST(Gltf, Cameras) {
  GltfBuilder file = with_square();
  file.root["cameras"] =
      json::parse(R"([{"name": "front", "type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}},
    {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 3, "znear": 0.1, "zfar": 10}},
    {"type": "perspective", "perspective": {"yfov": 4, "znear": 0.1}}])");
  file.add_node({{"camera", 0}, {"translation", {0.5, 0.5, 4}}});
  file.add_node({{"camera", 1},
                 {"name", "side"},
                 {"translation", {5, 0, 0}},
                 {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}}});
  file.add_node({{"camera", 2}});
  const Model model = read(file.text());
  ASSERT_EQ(model.cameras.size(), 3u);
  EXPECT_EQ(model.cameras[0].name, "front");
  EXPECT_EQ(model.cameras[0].camera.projection, Projection::perspective);
  EXPECT_NEAR(model.cameras[0].camera.fov, 0.5 * 180 / 3.14159265358979, 1e-9);
  EXPECT_EQ(model.cameras[0].camera.eye, (Vec3<double>{0.5, 0.5, 4}));
  EXPECT_NEAR(model.cameras[0].camera.target.z, 0, 1e-12);  // at the middle of the square
  EXPECT_EQ(model.cameras[0].camera.up, (Vec3<double>{0, 1, 0}));
  EXPECT_EQ(model.cameras[1].name, "side");
  EXPECT_EQ(model.cameras[1].camera.projection, Projection::orthographic);
  EXPECT_EQ(model.cameras[1].camera.height, 6);
  EXPECT_LT(model.cameras[1].camera.target.x, 4.9);  // turned to -x
  EXPECT_NEAR(model.cameras[1].camera.target.z, 0, 1e-12);
  EXPECT_EQ(model.cameras[2].camera.fov, 179);
  EXPECT_TRUE(
      any_contains(warnings_of(model), "/cameras/2/perspective/yfov: is beyond what a camera can see"));
}

TEST(Gltf, Lights) {
  constexpr double pi = 3.14159265358979323846;
  GltfBuilder file = with_square();
  file.root["extensionsUsed"] = {"KHR_lights_punctual"};
  file.root["extensions"] = json::parse(R"({"KHR_lights_punctual": {"lights": [
    {"type": "point", "name": "lamp", "color": [1, 0.5, 0], "intensity": 20, "range": 7},
    {"type": "directional", "intensity": 3}, {"type": "spot", "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.4}}, {"type": "spot", "spot": {}}]}})");
  for (int i = 0; i < 4; ++i)
    file.add_node({{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}},
                   {"translation", {0, i, 0}},
                   {"scale", {3, 3, 3}}});
  file.add_node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  const Model model = read(file.text());
  ASSERT_EQ(model.lights.size(), 5u);
  const auto& point = std::get<PointLight>(model.lights[0].light);
  EXPECT_EQ(model.lights[0].name, "lamp");
  EXPECT_EQ(model.lights[4].name, "lamp 2");
  EXPECT_DOUBLE_EQ(point.intensity, 20 / pi);
  EXPECT_EQ(point.color, (Rgb{{1, 0.5, 0}}));
  EXPECT_EQ(point.max_distance, 7);
  const auto& sun = std::get<DirectionalLight>(model.lights[1].light);
  EXPECT_EQ(sun.direction, (Vec3<double>{0, 0, -1}));
  EXPECT_DOUBLE_EQ(sun.intensity, 3 / pi);
  const auto& spot = std::get<SpotLight>(model.lights[2].light);
  EXPECT_EQ(spot.position, (Vec3<double>{0, 2, 0}));
  EXPECT_EQ(spot.target, (Vec3<double>{0, 2, -1}));
  EXPECT_NEAR(spot.angle, 0.8 * 180 / pi, 1e-9);
  EXPECT_NEAR(spot.softness, 0.5, 1e-12);
  EXPECT_NEAR(std::get<SpotLight>(model.lights[3].light).angle, 90, 1e-9);
  EXPECT_EQ(std::get<SpotLight>(model.lights[3].light).softness, 1);
}

// ---- what moves

TEST(Gltf, MorphTargets) {
  GltfBuilder file;
  const std::size_t positions = file.add(square, "VEC3"),
                    up = file.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3"),
                    right = file.add<float>({2, 0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0}, "VEC3");
  file.show(
      {{"attributes", {{"POSITION", positions}}}, {"targets", {{{"POSITION", up}}, {{"POSITION", right}}}}});
  file.root["meshes"][0]["weights"] = {0.5, 0};
  file.add_node({{"mesh", 0}, {"weights", {0, 0.25}}});
  file.add_node({{"mesh", 0}});
  const Model model = read(file.text());
  ASSERT_EQ(model.shapes.size(), 2u);  // the first and the last node show the same
  EXPECT_EQ(mesh_of(model, 0).vertices[0], (Vec3<float>{0, 0, 0.5f}));
  EXPECT_EQ(mesh_of(model, 1).vertices[0], (Vec3<float>{0.5f, 0, 0}));
  EXPECT_EQ(model.objects[2].shape, model.objects[0].shape);
}

/// A square whose upper edge hangs on a second joint, which an animation turns and moves.
GltfBuilder with_skin() {
  GltfBuilder file;
  const std::size_t positions = file.add(square, "VEC3"), normals = file.add(up_z, "VEC3");
  const std::size_t joints = file.add<std::uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4"),
                    weights = file.add<float>({1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0.5, 0, 0}, "VEC4");
  const std::size_t binds = file.add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,  //
                                             1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1},
                                            "MAT4");
  file.show({{"attributes",
              {{"POSITION", positions}, {"NORMAL", normals}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
             {"indices", file.add(two_triangles, "SCALAR")}});
  file.root["nodes"] = json::parse(R"([{"mesh": 0, "skin": 0, "translation": [100, 0, 0]},
    {"children": [2], "translation": [10, 0, 0]}, {"translation": [0, 1, 0]}])");
  file.root["scenes"][0]["nodes"] = {0, 1};
  file.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", binds}}};
  return file;
}

TEST(Gltf, Skins) {
  GltfBuilder file = with_skin();
  Model model = read(file.text());
  ASSERT_EQ(model.objects.size(), 1u);
  EXPECT_TRUE(is_identity(model.objects[0].world_from_object));  // the joints place it, not its node
  EXPECT_EQ(mesh_of(model).vertices[0], (Vec3<float>{10, 0, 0}));
  EXPECT_EQ(mesh_of(model).vertices[2], (Vec3<float>{11, 1, 0}));
  file.root["nodes"][2]["rotation"] = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // y to z
  file.root["nodes"][2]["translation"] = {0, 3, 0};
  model = read(file.text());
  EXPECT_NEAR(mesh_of(model).vertices[2].y, 3, 1e-6);
  EXPECT_NEAR(mesh_of(model).vertices[3].y, 2, 1e-6);  // half of each
  EXPECT_NEAR(mesh_of(model).normals[2].y, -1, 1e-6);
  file.root["skins"][0]["joints"] = {1};
  EXPECT_TRUE(any_contains(errors_of(file.text()), "has joint 1, but the skin has 1"));
}

TEST(Gltf, APartWithoutJointsIsLeftOutWithItsFlatNode) {
  // The part with joints would be shown, but has no area.
  GltfBuilder file = with_skin();
  json& primitives = file.root["meshes"][0]["primitives"];
  primitives.push_back({{"attributes", {{"POSITION", primitives[0]["attributes"]["POSITION"]}}}});
  primitives[0]["indices"] = file.add<std::uint16_t>({0, 0, 0}, "SCALAR");
  file.root["nodes"][0]["scale"] = {0, 0, 0};
  const Model model = read(file.text());
  EXPECT_TRUE(model.objects.empty());
  EXPECT_TRUE(model.shapes.empty());
  EXPECT_TRUE(any_contains(warnings_of(model), "the scene shows nothing"));
}

TEST(Gltf, AFileOfNothingIsAModelOfNothing) {
  const Model model = read(R"({"asset": {"version": "2.0"}})");
  EXPECT_TRUE(model.shapes.empty());
  EXPECT_EQ(model.materials.size(), 1u);
  EXPECT_EQ(warnings_of(model), Strings{"model.gltf: warning: the file shows nothing"});
}

TEST(Gltf, NamesAreCutOffBetweenCharacters) {
  // Nodes that share a mesh have its name each time.
  std::string name = "a";
  for (int i = 0; i < 150; ++i) name += "\u00e9";
  GltfBuilder file = with_square();
  file.root["meshes"][0]["name"] = name;
  EXPECT_EQ(read(file.text()).objects.at(0).name, name.substr(0, 199) + "...");
  file.root["meshes"][0]["name"] = name.substr(0, 199);
  EXPECT_EQ(read(file.text()).objects.at(0).name, name.substr(0, 199));
}

TEST(Gltf, SharingMakesNoModelOfAnySize) {
  // Primitives of the same numbers.
  GltfBuilder file;
  const json primitive = {
      {"attributes", {{"POSITION", file.add(std::vector<float>(3 * 3000, 0.5f), "VEC3")}}}, {"mode", 0}};
  file.show(primitive);
  json& primitives = file.root["meshes"][0]["primitives"];
  primitives = json(400, primitive);
  EXPECT_TRUE(any_contains(errors_of(file.text()), "more than 4 primitives for each byte of its file"));
  primitives = json(300, primitive);  // less than a million are let pass in any case
  EXPECT_EQ(read(file.text()).objects.size(), 300u);
  // Nodes of the same mesh.
  GltfBuilder wide;
  wide.show({{"attributes", {{"POSITION", wide.add(square, "VEC3")}}}, {"mode", 0}});
  wide.root["meshes"][0]["primitives"] = json(400, wide.root["meshes"][0]["primitives"][0]);
  for (int i = 0; i < 400; ++i) wide.add_node({{"mesh", 0}});
  EXPECT_TRUE(any_contains(errors_of(wide.text()), "the scene shows more objects than its file has bytes"));
  // Primitives of the same sparse accessor.
  GltfBuilder sparse;
  constexpr std::size_t count = 2000;
  std::vector<std::uint16_t> places(count);
  for (std::size_t i = 0; i < count; ++i) places[i] = std::uint16_t(i);
  std::vector<float> values(3 * count, 0);
  values[3] = values[7] = 1;  // (1, 0, 0) and (0, 1, 0)
  sparse.add(places, "SCALAR"), sparse.add(values, "VEC3");
  sparse.root["accessors"].push_back({{"componentType", 5126},
                                      {"count", count},
                                      {"type", "VEC3"},
                                      {"min", {0, 0, 0}},
                                      {"max", {1, 1, 0}},
                                      {"sparse",
                                       {{"count", count},
                                        {"indices", {{"bufferView", 0}, {"componentType", 5123}}},
                                        {"values", {{"bufferView", 1}}}}}});
  const json one = {{"attributes", {{"POSITION", 2}}},
                    {"indices", sparse.add<std::uint16_t>({0, 1, 2}, "SCALAR")}};
  sparse.show(one);
  EXPECT_EQ(read(sparse.text()).shapes.size(), 1u);
  sparse.root["meshes"][0]["primitives"] = json(1000, one);
  EXPECT_TRUE(
      any_contains(errors_of(sparse.text()), "/accessors/2/sparse: what shares its elements makes them"));
  // Colours of points, each for several materials.
  GltfBuilder dots;
  std::vector<std::uint16_t> colors;
  const auto level = [](int i) { return std::uint16_t(std::lround(65535.0 * i * i / (31 * 31))); };
  for (int i = 0; i < 17000; ++i)
    colors.insert(colors.end(), {level(i % 32), level(i / 32 % 32), level(i / 1024), 65535});
  const std::size_t of = dots.add(colors, "VEC4", true),
                    at = dots.add(std::vector<float>(3 * 17000, 0.5f), "VEC3");
  for (int material = 0; material < 4; ++material) {
    dots.root["materials"].push_back(json::object());
    dots.show({{"attributes", {{"POSITION", at}, {"COLOR_0", of}}}, {"mode", 0}, {"material", material}});
  }
  EXPECT_TRUE(any_contains(errors_of(dots.text()), "materials, too many for a file of this size"));
}

TEST(Gltf, AnimationsAtATime) {
  const auto position = [](const json& sampler, std::optional<double> time,
                           const char* path = "translation") {
    GltfBuilder file = with_square();
    const std::size_t times = file.add<float>({1, 2, 4}, "SCALAR");
    const std::size_t values =
        std::string(path) == "rotation"
            ? file.add<float>({0, 0, 0, 1, 0, 0, std::sqrt(0.5f), std::sqrt(0.5f), 0, 0, 1, 0}, "VEC4")
        : sampler["interpolation"] == "CUBICSPLINE"
            ? file.add<float>(
                  {0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 5, 0, 0, -1, 0, 0, 0, 0, 0, 9, 0, 0, 0, 0, 0}, "VEC3")
            : file.add<float>({0, 0, 0, 5, 0, 0, 9, 0, 0}, "VEC3");
    json full = sampler;
    full["input"] = times, full["output"] = values;
    file.root["animations"] = {
        {{"samplers", {full}}, {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}}};
    ImportOptions options;
    options.time = time;
    return transform_point(read(file.text(), {}, options).objects.at(0).world_from_object, {1, 0, 0});
  };
  const json linear = {{"interpolation", "LINEAR"}}, step = {{"interpolation", "STEP"}},
             cubic = {{"interpolation", "CUBICSPLINE"}};
  EXPECT_NEAR(position(linear, {}).x, 1, 1e-12);  // at rest
  EXPECT_NEAR(position(linear, 0).x, 1, 1e-12);   // before the first key
  EXPECT_NEAR(position(linear, 1.5).x, 3.5, 1e-6);
  EXPECT_NEAR(position(linear, 3).x, 8, 1e-6);
  EXPECT_NEAR(position(linear, 99).x, 10, 1e-6);
  EXPECT_NEAR(position(step, 1.99).x, 1, 1e-6);
  EXPECT_NEAR(position(step, 2).x, 6, 1e-6);
  // Hermite in the middle of the first piece: (0 + 5) / 2 + (1 - 0) / 8.
  EXPECT_NEAR(position(cubic, 1.5).x, 1 + 2.5 + 0.125, 1e-6);
  // And of the second, 2 seconds long, with tangents -1 and 0: (5 + 9) / 2 + 2 (-1) / 8.
  EXPECT_NEAR(position(cubic, 3).x, 1 + 7 - 0.25, 1e-6);
  EXPECT_NEAR(position(linear, 1.5, "rotation").x, std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(position(linear, 1.5, "rotation").y, std::sqrt(0.5), 1e-6);
}

TEST(Gltf, AnimationsThatDoNotContradictMoveTogether) {
  GltfBuilder file = with_square();
  file.add_node({{"mesh", 0}});
  const std::size_t times = file.add<float>({0, 1}, "SCALAR"),
                    values = file.add<float>({0, 0, 0, 2, 0, 0}, "VEC3"),
                    others = file.add<float>({0, 0, 0, 0, 4, 0}, "VEC3");
  const auto animation = [&](int node, std::size_t output, const char* name) {
    return json{{"name", name},
                {"samplers", {{{"input", times}, {"output", output}}}},
                {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}}}};
  };
  file.root["animations"] = {animation(0, values, "walk"), animation(1, values, "door"),
                             animation(0, others, "run")};
  ImportOptions options;
  options.time = 1;
  const Model model = read(file.text(), {}, options);
  EXPECT_EQ(model.objects[0].world_from_object.translation, (Vec3<double>{2, 0, 0}));
  EXPECT_EQ(model.objects[1].world_from_object.translation, (Vec3<double>{2, 0, 0}));
  EXPECT_TRUE(any_contains(warnings_of(model), "/animations/2: 'run' moves what an earlier animation moves"));
}

// ---- files of others

TEST(Gltf, FilesOfOthersAreReadOrRefused) {
  const auto data = test::data_dir();
  if (!data || !std::filesystem::is_directory(*data + "/gltf"))
    GTEST_SKIP() << "no files of others: set LAMBENT_DATA";
  std::size_t files = 0;
  for (const char* folder : {"/gltf", "/gltf-invalid"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(*data + folder)) {
      const std::string path = entry.path().string();
      if (!path.ends_with(".gltf") && !path.ends_with(".glb")) continue;
      ++files;
      try {
        const Model model = import_model(path);
        for (const ModelObject& object : model.objects) EXPECT_LT(object.shape, model.shapes.size()) << path;
        for (const Shape& shape : model.shapes)
          for (const std::uint32_t material : shape.material_of_primitive)
            EXPECT_LT(material, model.materials.size()) << path;
      } catch (const InputError& error) {
        const bool must_be_valid = path.find("/gltf/khronos/") != std::string::npos ||
                                   path.find("/gltf/assimp/") != std::string::npos ||
                                   path.find("/gltf/flighthelmet/") != std::string::npos;
        EXPECT_FALSE(must_be_valid) << to_string(error.diagnostics()[0]);
      }
    }
  EXPECT_GT(files, 300u);
}

TEST(Gltf, TheValidatorAgrees) {
  const auto data = test::data_dir();
  const std::string folder = data ? *data + "/gltf-invalid/validator" : "";
  if (!data || !std::filesystem::is_directory(folder))
    GTEST_SKIP() << "no reports of the validator: set LAMBENT_DATA";
  // docs/gltf.md says why.
  const Strings accepted{"invalid_image_data.gltf", "no_tangent_space.gltf", "png_eos.gltf"};
  Strings different;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string report = entry.path().string();
    if (!report.ends_with(".report.json")) continue;
    const json messages = json::parse(test::read_text(report)).at("issues").at("messages");
    const bool wrong =
        std::any_of(messages.begin(), messages.end(), [](const json& m) { return m.at("severity") == 0; });
    const std::string path = report.substr(0, report.size() - 12);
    bool refused = false;
    try {
      import_model(path);
    } catch (const InputError&) {
      refused = true;
    }
    if (refused != wrong) different.push_back(std::filesystem::path(path).filename().string());
  }
  std::sort(different.begin(), different.end());
  EXPECT_EQ(different, accepted);
}

TEST(Gltf, DamagedFilesAreReadOrRefused) {
  const std::string good = with_skin().text();
  const GltfBuilder file = with_skin();
  RC_ASSERT(errors_of(good).empty());
  rc::check("every file is read or refused", [&] {
    const bool binary = *rc::gen::arbitrary<bool>();
    std::string bytes = binary ? file.binary() : good;
    const int edits = *rc::gen::inRange(1, 5);
    for (int i = 0; i < edits; ++i) {
      const auto at = *rc::gen::inRange<std::size_t>(0, bytes.size());
      if (*rc::gen::arbitrary<bool>()) bytes[at] = *rc::gen::arbitrary<char>();
      else if (const std::size_t digit = bytes.find_first_of("0123456789", at); digit != std::string::npos)
        bytes[digit] = char('0' + *rc::gen::inRange(0, 10));
    }
    errors_of(bytes, binary ? "model.glb" : "model.gltf");
  });
}

}  // namespace
}  // namespace lambent
