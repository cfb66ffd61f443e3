// Transforms: steps in the order written.

#include <cmath>

#include "scenefile/nearest.h"
#include "scenefile/read_objects.h"
#include "scenefile/shape_settings.h"

namespace lambent {
namespace {

bool scale_step(Reader& reader, const Value& value, const Field& field, Transform& out) {
  Vec3<double> by{1, 1, 1};
  if (value.node->kind == Node::Kind::list) {
    if (!reader.vector(value, limits(field), by)) return false;
  } else {
    if (!reader.number(value, limits(field), by.x)) return false;
    by = {by.x, by.x, by.x};
  }
  if (min(min(abs(by.x), abs(by.y)), abs(by.z)) < positive.min) {
    reader.error(*value.node, value.label + " flattens everything: a factor is 0",
                 "to leave an axis as it is, write 1");
    return false;
  }
  out = scaling(by);
  return true;
}

bool read_turn(Reader& reader, const Value& value, MotionStep& out) {
  const auto values = reader.mapping(value, format().rotate.fields, "a rotate");
  if (!values) return false;
  const std::size_t before = reader.count();
  Vec3<double> axis{0, 1, 0};
  if (const Value* one = values->find("axis")) {
    if (one->node->kind == Node::Kind::list) {
      reader.direction(*one, {-largest_coordinate, largest_coordinate}, axis);
    } else {
      std::string word;
      if (reader.one_of(*one, {"x", "y", "z"}, word))
        axis = word == "x"   ? Vec3<double>{1, 0, 0}
               : word == "y" ? Vec3<double>{0, 1, 0}
                             : Vec3<double>{0, 0, 1};
    }
  }
  RotateSettings settings;
  reader.table(*values, format().rotate.fields, settings);
  if (reader.count() != before || values->unknown_keys) return false;
  out.axis = normalize(axis);
  out.degrees = settings.degrees;
  out.center = settings.center;
  return true;
}

bool rotate_step(Reader& reader, const Value& value, Transform& out) {
  MotionStep turn;
  if (!read_turn(reader, value, turn)) return false;
  out = rotation_about(turn.center, turn.axis, turn.degrees);
  return true;
}

bool matrix_step(Reader& reader, const Value& value, const Field& field, Transform& out) {
  const auto rows = reader.list(value, "row");
  if (!rows) return false;
  if (rows->size() != 3) {
    reader.error(
        *value.node,
        value.label + " must have 3 rows of 4 numbers, not " + std::to_string(rows->size()) + " rows",
        "the last row of a 4 by 4 matrix, 0 0 0 1, is left out");
    return false;
  }
  std::array<std::array<double, 4>, 3> m{};
  bool good = true;
  for (std::size_t i = 0; i < 3; ++i) {
    Value row = (*rows)[i];
    row.label += " of " + value.label;
    good = reader.numbers(row, limits(field), m[i]) && good;
  }
  if (!good) return false;
  out = {{m[0][0], m[1][0], m[2][0]},
         {m[0][1], m[1][1], m[2][1]},
         {m[0][2], m[1][2], m[2][2]},
         {m[0][3], m[1][3], m[2][3]}};
  // Compared with the product of the columns' lengths, so that a small scale is no fault.
  const double volume = length(out.x) * length(out.y) * length(out.z);
  if (!(abs(determinant(out)) > 1e-12 * volume) || !std::isfinite(volume)) {
    reader.error(*value.node, value.label + " flattens everything: its determinant is 0");
    return false;
  }
  return true;
}

/// The one key of a step, and what stands behind it.
std::optional<Value> only_key(Reader& reader, const Value& value, const std::vector<Field>& fields,
                              const std::string& what) {
  const auto values = reader.mapping(value, fields, what);
  if (!values || values->unknown_keys) return {};
  if (values->values.empty()) {
    reader.error(value.place(), "this step does nothing", "a step is one of: " + join(names_of(fields)));
    return {};
  }
  if (values->values.size() > 1) {
    reader.error(
        *values->values[1].key,
        values->values[1].label + " stands in one step with " + values->values[0].label,
        "steps are elements of a list, because their order matters: [{scale: 2}, {translate: [1, 0, 0]}]");
    return {};
  }
  return values->values[0];
}

bool step(Reader& reader, const Value& value, Transform& out) {
  const auto& fields = format().transform.fields;
  const auto only = only_key(reader, value, fields, "a transform");
  if (!only) return false;
  const Value& one = *only;
  const Field& field = *find(fields, one.key->text);
  if (field.name == "scale") return scale_step(reader, one, field, out);
  if (field.name == "rotate") return rotate_step(reader, one, out);
  if (field.name == "matrix") return matrix_step(reader, one, field, out);
  Vec3<double> by;
  if (!reader.vector(one, limits(field), by)) return false;
  out = translation(by);
  return true;
}

bool motion_step(Reader& reader, const Value& value, MotionStep& out) {
  const auto& fields = format().motion.fields;
  const auto only = only_key(reader, value, fields, "a motion");
  if (!only) return false;
  return only->key->text == "rotate"
             ? read_turn(reader, *only, out)
             : reader.vector(*only, limits(*find(fields, "translate")), out.translate);
}

}  // namespace

bool read_transform(Reader& reader, const Value& value, Transform& out) {
  if (value.node->kind != Node::Kind::list) {
    if (value.node->kind == Node::Kind::mapping) return step(reader, value, out);
    return reader.list(value, "step").has_value();  // which says what is wrong
  }
  const auto steps = reader.list(value, "step");
  if (!steps) return false;
  bool good = true;
  Transform all;
  for (const Value& one : *steps) {
    Transform next;
    good = step(reader, one, next) && good;
    all = next * all;
  }
  if (good) out = all;
  return good;
}

bool read_motion(Reader& reader, const Value& value, std::vector<MotionStep>& out) {
  const std::size_t before = reader.count();
  const auto add = [&](const Value& one) {
    MotionStep step;
    if (motion_step(reader, one, step)) out.push_back(step);
  };
  if (value.node->kind == Node::Kind::mapping) {
    add(value);
  } else if (const auto steps = reader.list(value, "step")) {
    for (const Value& one : *steps) add(one);
  }
  return reader.count() == before;
}

}  // namespace lambent
