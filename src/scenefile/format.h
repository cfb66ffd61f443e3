#pragma once
// Everything that a scene file may say, as data. The reader, the JSON Schema, the manual and the catalogue
// are made from it, and it is made from the tables of parameters and the registries of models and lights, so
// a new one shows up in all of them.

#include <string>
#include <string_view>
#include <vector>

#include "parameters/parameter.h"

namespace lambent {

/// What a value may be.
enum class FieldType {
  number,
  integer,
  boolean,
  color,
  vector,
  point,
  direction,
  choice,
  name,
  file,
  image_size,  // [width, height], whole numbers
  extent,      // [width, height]
  points,
  triangles,
  directions,
  uvs,
  factors,      // a number or three
  axis,         // x, y, z or a direction
  matrix,       // three rows of four
  attenuation,  // a choice or a mapping
  samples,      // a whole number or a mapping
  material,     // a name or a mapping
  background,   // a color or a mapping
  map,          // a file's name or a mapping
  substance,    // a name or a mapping
  numbers,      // a list of numbers
  wavelengths,  // how many, or a list of them
  transform,    // a step or a list of steps
  motion,       // likewise
  section,      // a mapping with fields of its own
  sections,     // a list of such mappings
};

/// One key of a mapping.
struct Field {
  std::string name;
  FieldType type = FieldType::number;
  Range range;  ///< As people see it; `limits` is what the reader accepts.
  std::string unit;
  std::string default_value;  ///< As one would write it, or empty.
  std::string sentence;
  bool required = false;
  std::vector<std::string> choices;  ///< Of a choice.
};

/// A mapping of the scene file.
struct Section {
  std::string name, title, equation, source, differs;
  std::vector<Field> fields;
  std::string attenuation,
      ambient_attenuation;  ///< A model's defaults, as one would write them; otherwise empty.
};

struct Format {
  Section top, camera, image, film, samples, adaptive, illumination, attenuation, integrator, material;
  Section background, fog, ambient_occlusion, maps, map, metallic_roughness;
  Section metal, glass, spectrum;
  Field material_name;  ///< What an entry of `materials` has beside the fields of `material`.
  std::vector<Section> integrators, models, lights, shapes;
  Section light, object;  ///< What every light and object may say beside its kind.
  Section transform;      ///< The steps.
  Section motion;         ///< Those of a motion.
  Section rotate;
};
const Format& format();

/// The largest magnitude of a number that is not a length: products of two of them stay finite in float.
inline constexpr double largest_number = 1e18;

/// `range`, closed where it is open: lengths end where ray queries do.
Range limits(const Field& field);

/// "0 to 1", "at least 0", "positive", or empty for any number.
std::string describe(const Range& range);

/// The type's name for people: "number", "color", ...
std::string type_name(FieldType type);

std::vector<std::string> names_of(const std::vector<Field>& fields);
std::vector<std::string> names_of(const std::vector<Section>& sections);
const Field* find(const std::vector<Field>& fields, std::string_view name);
const Section* find(const std::vector<Section>& sections, std::string_view name);

/// A number as one would write it: the shortest text that reads back as the same.
std::string text_of(double value);
std::string text_of(const Vec3<double>& value);
std::string text_of(const Rgb& value);

}  // namespace lambent
