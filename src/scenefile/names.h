#pragma once
// The words that scene files use for the choices of the scene.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace lambent {

/// The table of the choice E: what it is called, what it is.
template <class E> inline constexpr int words_of = 0;
template <>
inline constexpr std::pair<const char*, Projection> words_of<Projection>[] = {
    {"perspective", Projection::perspective}, {"orthographic", Projection::orthographic}};
template <>
inline constexpr std::pair<const char*, Filter> words_of<Filter>[] = {{"box", Filter::box},
                                                                      {"tent", Filter::tent}};
template <>
inline constexpr std::pair<const char*, Pattern> words_of<Pattern>[] = {{"stratified", Pattern::stratified},
                                                                        {"corners", Pattern::corners}};
template <>
inline constexpr std::pair<const char*, Encoding> words_of<Encoding>[] = {{"srgb", Encoding::srgb},
                                                                          {"none", Encoding::none}};
template <>
inline constexpr std::pair<const char*, AmbientAttenuation> words_of<AmbientAttenuation>[] = {
    {"none", AmbientAttenuation::none}, {"1/R", AmbientAttenuation::one_over_R}};
template <>
inline constexpr std::pair<const char*, Attenuation> words_of<Attenuation>[] = {
    {"none", attenuation_none}, {"1/r", attenuation_1_over_r}, {"1/r^2", attenuation_1_over_r2}};
template <>
inline constexpr std::pair<const char*, Integrator> words_of<Integrator>[] = {
    {"whitted", Integrator::whitted},
    {"spectral", Integrator::spectral},
    {"path", Integrator::path},
    {"ambient_occlusion", Integrator::ambient_occlusion},
    {"view", Integrator::view}};
template <>
inline constexpr std::pair<const char*, View> words_of<View>[] = {
    {"normals", View::normals}, {"depth", View::depth},
    {"uv", View::uv},           {"primitives", View::primitives},
    {"objects", View::objects}, {"materials", View::materials},
    {"rays", View::rays},       {"cosine", View::cosine}};
template <>
inline constexpr std::pair<const char*, Alpha> words_of<Alpha>[] = {{"blend", Alpha::blend},
                                                                    {"mask", Alpha::mask}};
template <>
inline constexpr std::pair<const char*, Wrap> words_of<Wrap>[] = {
    {"repeat", Wrap::repeat}, {"mirror", Wrap::mirror}, {"clamp", Wrap::clamp}};
template <>
inline constexpr std::pair<const char*, MapSlot> words_of<MapSlot>[] = {
    {"ambient", MapSlot::ambient},
    {"diffuse", MapSlot::diffuse},
    {"specular", MapSlot::specular},
    {"shininess", MapSlot::shininess},
    {"reflect", MapSlot::reflect},
    {"transmit", MapSlot::transmit},
    {"emission", MapSlot::emission},
    {"opacity", MapSlot::opacity},
    {"normal", MapSlot::normal},
    {"bump", MapSlot::bump},
    {"occlusion", MapSlot::occlusion},
    {"base_color", MapSlot::base_color},
    {"metallic", MapSlot::metallic},
    {"roughness", MapSlot::roughness},
    {"specular_factor", MapSlot::specular_factor},
    {"specular_color", MapSlot::specular_color},
    {"transmission", MapSlot::transmission},
    {"clearcoat", MapSlot::clearcoat},
    {"clearcoat_roughness", MapSlot::clearcoat_roughness}};

template <class E> std::vector<std::string> names_of() {
  std::vector<std::string> names;
  for (const auto& [word, value] : words_of<E>) names.push_back(word);
  return names;
}

/// What `word` means, or nothing.
template <class E> std::optional<E> meaning_of(std::string_view word) {
  for (const auto& [name, value] : words_of<E>)
    if (word == name) return value;
  return {};
}

std::string text_of(double value);  // of format.h

/// As one would write it.
template <class E>
requires requires { words_of<E>[0].first; }
std::string text_of(const E& wanted) {
  for (const auto& [name, value] : words_of<E>)
    if (value == wanted) return name;
  if constexpr (std::is_same_v<E, Attenuation>)
    return "{constant: " + text_of(wanted.constant) + ", linear: " + text_of(wanted.linear) +
           ", quadratic: " + text_of(wanted.quadratic) + "}";
  return {};
}

}  // namespace lambent
