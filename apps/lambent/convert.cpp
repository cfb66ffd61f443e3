#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "commands.h"
#include "console.h"
#include "files.h"
#include "lambent/lambent.h"

namespace lambent::app {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_remarks = 50;

/// The name of `file` in a scene that stands in `folder`.
std::string seen_from(const fs::path& folder, const fs::path& file) {
  return fs::relative(fs::absolute(file), folder).generic_string();
}
bool lies_outside(const std::string& name) { return name.substr(0, 3) == "../"; }

/// The library's scene names the model as if it stood beside it. Name it as seen from the scene's folder.
std::string naming_model_from(const fs::path& folder, const fs::path& model, std::string scene) {
  constexpr std::string_view before = "mesh: {file: ", after = "}}";
  const std::size_t begin = scene.find(before) + before.size();
  const std::size_t end = scene.find('\n', begin) - after.size();
  // JSON is YAML, so a name in JSON's quotes is one in YAML's.
  const nlohmann::json name = seen_from(folder, model);
  return scene.replace(begin, end - begin,
                       name.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

/// Scenes are work of somebody's: they are not overwritten unasked.
void must_be_free(const ConvertCommand& command) {
  std::error_code ignored;
  if (fs::exists(command.to, ignored) && !command.force)
    throw usage_error(fmt::format("'{}' is there already", command.to), "--force overwrites it");
  check_output(command.to);
}

void scene_from_model(const ConvertCommand& command) {
  must_be_free(command);
  const fs::path folder = fs::absolute(command.to).parent_path();
  LoadOptions options = command.load;
  if (is_readable_picture(options.background)) options.background = seen_from(folder, options.background);
  write_text_file(command.to,
                  naming_model_from(folder, command.from, scene_text_of_model(command.from, options)));
  if (lies_outside(seen_from(folder, command.from)) || lies_outside(options.background)) {
    Diagnostic remark;
    remark.severity = Severity::warning;
    remark.place.file = command.to;
    remark.message = "the scene names a file outside of its own folder";
    remark.hint = "'lambent render' wants --allow-outside for it; or put the scene beside the model";
    report(remark);
  }
}

void export_for_others(const ConvertCommand& command, ExportFormat format) {
  must_be_free(command);
  const ScenePtr scene = load_scene(command.from, command.load);
  std::vector<Diagnostic> remarks = warnings(scene);
  const std::string text = export_scene(scene, format, remarks);
  report(remarks, most_remarks);
  write_text_file(command.to, text);
}

}  // namespace

ExitCode run(const ConvertCommand& command) {
  const std::string to = ending(command.to);
  const bool picture_given = is_readable_picture(command.from);
  if (picture_given && is_image_file(command.to)) {
    check_output(command.to);
    const ReadImage picture = read_image(command.from, command.load.limits);
    write_image(command.to, picture.image, picture.metadata, {command.bits, true});
  } else if (!picture_given && (to == ".yaml" || to == ".yml")) {
    scene_from_model(command);
  } else if (!picture_given && (to == ".pov" || to == ".dat")) {
    export_for_others(command, to == ".pov" ? ExportFormat::povray : ExportFormat::tachyon);
  } else if (is_image_file(command.to)) {
    throw usage_error(fmt::format("'{}' is not a picture", command.from),
                      fmt::format("'lambent render {} -o {}' makes a picture of a scene or a model",
                                  command.from, command.to));
  } else {
    throw usage_error(
        fmt::format("cannot make '{}' of '{}'", command.to, command.from),
        "a model becomes a scene (.yaml), a scene or a model a scene of POV-Ray (.pov) or Tachyon "
        "(.dat), a picture a picture (.png, .exr)");
  }
  return done;
}

}  // namespace lambent::app
