#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "console.h"
#include "files.h"
#include "lambent/lambent.h"
#include "nearest.h"

namespace lambent::app {

namespace {

using Json = nlohmann::ordered_json;

// ---- as JSON
// ----------------------------------------------------------------------------------------------------------

Json as_json(const Entry& entry) {
  Json parameters = Json::array();
  for (const ParameterInfo& parameter : entry.parameters) {
    parameters.push_back({{"name", parameter.name},
                          {"type", parameter.type},
                          {"unit", parameter.unit},
                          {"default", parameter.default_value},
                          {"range", parameter.range},
                          {"required", parameter.required},
                          {"sentence", parameter.sentence}});
  }
  return {{"name", entry.name},     {"title", entry.title},     {"equation", entry.equation},
          {"source", entry.source}, {"differs", entry.differs}, {"parameters", std::move(parameters)}};
}

Json as_json(const Topic& topic) {
  Json entries = Json::array();
  for (const Entry& entry : topic.entries) entries.push_back(as_json(entry));
  return {{"name", topic.name}, {"title", topic.title}, {"entries", std::move(entries)}};
}

Json as_json(const std::vector<Topic>& topics) {
  Json json = Json::array();
  for (const Topic& topic : topics) json.push_back(as_json(topic));
  return json;
}

// ---- as text
// ----------------------------------------------------------------------------------------------------------

template <class Named> std::vector<std::string> names_of(const std::vector<Named>& list) {
  std::vector<std::string> names;
  for (const Named& one : list) names.push_back(one.name);
  return names;
}

/// "name   text", the text wrapped behind the widest name.
std::string row(std::string_view name, std::string_view text, int indent, int name_width, int width) {
  const int text_column = indent + name_width + 2;
  std::string lines = wrapped(text, width, text_column);
  if (lines.empty()) return fmt::format("{:{}}{}\n", "", indent, name);
  return fmt::format("{:{}}{:<{}}{}", "", indent, name, name_width + 2,
                     lines.substr(std::size_t(text_column)));
}

template <class Named> int widest(const std::vector<Named>& list) {
  std::size_t widest = 0;
  for (const Named& one : list) widest = std::max(widest, one.name.size());
  return int(widest);
}

std::string as_text(const std::vector<Topic>& topics, int width) {
  std::string text;
  for (const Topic& topic : topics) {
    text += row(topic.name, topic.title, 0, int(topic.name.size()), width);
    for (const Entry& entry : topic.entries)
      text += row(entry.name, entry.title, 2, widest(topic.entries), width);
    text += "\n";
  }
  return text + wrapped("'lambent list TOPIC [NAME]' says everything about one of them.", width, 0);
}

/// "number, 0 to 1, default 0.5, degrees".
std::string facts(const ParameterInfo& parameter) {
  std::string text = parameter.type;
  if (!parameter.unit.empty()) text += ", " + parameter.unit;
  if (!parameter.range.empty()) text += ", " + parameter.range;
  if (parameter.required) text += ", required";
  else if (!parameter.default_value.empty()) text += ", default " + parameter.default_value;
  return text;
}

std::string as_text(const Entry& entry, int width) {
  std::string text = row(entry.name, entry.title, 0, int(entry.name.size()), width);
  if (!entry.equation.empty()) text += wrapped(entry.equation, width, 4);
  if (!entry.source.empty()) text += wrapped("Source: " + entry.source, width, 4);
  if (!entry.differs.empty()) text += wrapped("How it differs: " + entry.differs, width, 4);
  for (const ParameterInfo& parameter : entry.parameters) {
    text += row(parameter.name, facts(parameter), 2, widest(entry.parameters), width);
    text += wrapped(parameter.sentence, width, 2 + widest(entry.parameters) + 2);
  }
  return text;
}

std::string as_text(const Topic& topic, int width) {
  std::string text = wrapped(topic.title, width, 0);
  for (const Entry& entry : topic.entries) {
    text += '\n';
    text += as_text(entry, width);
  }
  return text;
}

// ---- what was asked for
// -----------------------------------------------------------------------------------------------

template <class Named>
const Named& find(const std::vector<Named>& list, const std::string& name, const std::string& kind,
                  std::string hint = "") {
  for (const Named& one : list)
    if (one.name == name) return one;
  const std::vector<std::string> names = names_of(list);
  if (hint.empty()) hint = did_you_mean(name, names);
  if (hint.empty()) hint = fmt::format("known are {}", fmt::join(names, ", "));
  throw usage_error(fmt::format("unknown {} '{}'", kind, name), hint);
}

/// For a name given where a topic belongs: "did you mean 'lambent list models phong'?".
std::string topic_hint(const std::string& name) {
  for (const Topic& topic : catalogue())
    for (const Entry& entry : topic.entries)
      if (entry.name == name) return fmt::format("did you mean 'lambent list {} {}'?", topic.name, name);
  return "";
}

std::string ending_in_newline(std::string text) {
  if (text.empty() || text.back() != '\n') text += '\n';
  return text;
}

}  // namespace

ExitCode run(const ListCommand& command) {
  if (command.schema || command.manual) {
    print(ending_in_newline(command.schema ? scene_schema() : scene_manual()));
    return done;
  }
  const int width = columns(1);
  const auto show = [&](const auto& thing) {
    print(command.json ? as_json(thing).dump(2, ' ', false, Json::error_handler_t::replace) + "\n"
                       : as_text(thing, width));
  };
  if (command.topic.empty()) {
    show(catalogue());
  } else {
    const Topic& topic = find(catalogue(), command.topic, "topic", topic_hint(command.topic));
    if (command.name.empty()) show(topic);
    else show(find(topic.entries, command.name, "name in " + topic.name));
  }
  return done;
}

ExitCode run(const ShowText& command) {
  print(command.text);
  return done;
}

}  // namespace lambent::app
