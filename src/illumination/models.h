#pragma once
// The registry: every model of models.def as a number, a manual page and a type.

#include "generated/illumination_models.h"  // includes every file of models/; the build writes it

namespace lambent {

enum class ModelId : int {
#define LAMBENT_MODEL(name, Struct) name,
#include "illumination/models.def"
#undef LAMBENT_MODEL
};

inline constexpr int model_count = 0
#define LAMBENT_MODEL(name, Struct) +1
#include "illumination/models.def"
#undef LAMBENT_MODEL
    ;

inline namespace LAMBENT_ISA {

inline constexpr ModelInfo model_infos[] = {
#define LAMBENT_MODEL(name, Struct) Struct::info,
#include "illumination/models.def"
#undef LAMBENT_MODEL
};
constexpr const ModelInfo& info(ModelId id) { return model_infos[int(id)]; }

/// Calls visitor.operator()<Model>() with the struct of the model `id`.
template <class Visitor> decltype(auto) with_model(ModelId id, Visitor&& visitor) {
  switch (id) {
#define LAMBENT_MODEL(name, Struct) \
  case ModelId::name:               \
    return visitor.template operator()<Struct>();
#include "illumination/models.def"
#undef LAMBENT_MODEL
  }
  __builtin_unreachable();
}

/// The number of a model's struct.
template <class Model> inline constexpr ModelId id_of = ModelId(-1);
#define LAMBENT_MODEL(name, Struct) template <> inline constexpr ModelId id_of<Struct> = ModelId::name;
#include "illumination/models.def"
#undef LAMBENT_MODEL

}  // namespace LAMBENT_ISA
}  // namespace lambent
