// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "api/card_facts.h"
#include "dataset/files/sha256.h"

namespace beamgyro::internal {
namespace {

using CardJson = nlohmann::ordered_json;

// The whole context of Croissant 1.0, so that no reader needs a network.
CardJson croissant_context() {
  CardJson context = {{"@language", "en"}, {"@vocab", "https://schema.org/"}};
  context["citeAs"] = "cr:citeAs";
  context["column"] = "cr:column";
  context["conformsTo"] = "dct:conformsTo";
  context["cr"] = "http://mlcommons.org/croissant/";
  context["rai"] = "http://mlcommons.org/croissant/RAI/";
  context["data"] = {{"@id", "cr:data"}, {"@type", "@json"}};
  context["dataType"] = {{"@id", "cr:dataType"}, {"@type", "@vocab"}};
  context["dct"] = "http://purl.org/dc/terms/";
  context["examples"] = {{"@id", "cr:examples"}, {"@type", "@json"}};
  for (const char* name :
       {"extract", "field", "fileProperty", "fileObject", "fileSet", "format",
        "includes", "isLiveDataset", "jsonPath", "key", "md5", "parentField",
        "path", "recordSet", "references", "regex", "repeated", "replace"})
    context[name] = std::string("cr:") + name;
  context["sc"] = "https://schema.org/";
  for (const char* name : {"separator", "source", "subField", "transform"})
    context[name] = std::string("cr:") + name;
  return context;
}

CardJson file_json(const CardFile& file) {
  return {{"@type", "cr:FileObject"},
          {"@id", file.name},
          {"name", file.name},
          {"description", file.description},
          {"contentUrl", file.name},
          {"contentSize", fmt::format("{} B", file.bytes)},
          {"encodingFormat", file.format},
          {"sha256", file.sha256}};
}

/// A table whose lines stand in the file itself. A field has the same name and
/// id, which are the keys of the lines: readers look for one or the other.
class CroissantTable {
 public:
  CroissantTable(std::string id, const std::string& description)
      : id_(std::move(id)),
        table_({{"@type", "cr:RecordSet"},
                {"@id", id_},
                {"name", id_},
                {"description", description}}) {}

  CardJson& operator[](const char* key) { return table_[key]; }
  std::string field_id(const std::string& name) const {
    return id_ + "/" + name;
  }

  CardJson& add_field(const std::string& name, const std::string& type,
                      const std::string& description) {
    fields_.push_back({{"@type", "cr:Field"},
                       {"@id", field_id(name)},
                       {"name", field_id(name)},
                       {"description", description},
                       {"dataType", type}});
    return fields_.back();
  }

  void add_line(const std::vector<CardJson>& values) {
    CardJson line;
    for (std::size_t i = 0; i < values.size(); ++i)
      line[fields_[i]["@id"].get<std::string>()] = values[i];
    lines_.push_back(std::move(line));
  }

  CardJson taken() {
    table_["field"] = std::move(fields_);
    table_["data"] = std::move(lines_);
    return std::move(table_);
  }

 private:
  std::string id_;
  CardJson table_, fields_ = CardJson::array(), lines_ = CardJson::array();
};

CardJson splits_table() {
  CroissantTable table("splits",
                       "What devices are for. Samples of one device never "
                       "stand in two splits.");
  table["dataType"] = "cr:Split";
  table["key"] = {{"@id", "splits/name"}};
  table.add_field("name", "sc:Text", "The name in the set.");
  table.add_field("url", "sc:URL", "What it means in Croissant.");
  table.add_line({"train", "cr:TrainingSplit"});
  table.add_line({"validation", "cr:ValidationSplit"});
  table.add_line({"test", "cr:TestSplit"});
  return table.taken();
}

CardJson devices_table(const CardFacts& facts) {
  CroissantTable table("devices",
                       "The virtual gyros, with the numbers that were drawn "
                       "for each.");
  table["key"] = {{"@id", "devices/device"}};
  table.add_field("device", "sc:Integer", "Its number in the set.");
  table.add_field("split", "sc:Text", "What it is for.")["references"] = {
      {"field", {{"@id", "splits/name"}}}};
  table.add_field("failed", "sc:Text",
                  "Which runs have no values, and why; empty for none.");
  for (const CardParameter& parameter : facts.parameters)
    table.add_field(parameter.name, "sc:Float",
                    fmt::format("{} [{}]", parameter.about.long_name,
                                parameter.about.units));
  for (std::size_t device = 0; device < facts.parts.size(); ++device) {
    std::vector<CardJson> line = {device, facts.parts[device],
                                  facts.failures[device]};
    for (const CardParameter& parameter : facts.parameters)
      line.push_back(parameter.values[device]
                         ? CardJson(*parameter.values[device])
                         : CardJson());
    table.add_line(line);
  }
  return table.taken();
}

CardJson variables_table(const CardFacts& facts) {
  CroissantTable table("variables",
                       "What the files of each run hold, over device and time. "
                       "It is read with an HDF5 or netCDF library.");
  table["key"] = {{"@id", "variables/variable"}};
  table.add_field("variable", "sc:Text", "RUN/NAME.");
  table.add_field("units", "sc:Text", "Its unit, as in the files.");
  table.add_field("role", "sc:Text",
                  "measured: the gyro measures it; truth: only a simulator "
                  "knows it.");
  table.add_field("rate", "sc:Float", "Samples in a second [Hz].");
  table.add_field("description", "sc:Text", "What it is.");
  for (const CardRun& run : facts.runs) {
    const std::vector<double>& time = run.head.time;
    const double rate = time.size() > 1 ? 1 / (time[1] - time[0]) : 0;
    for (const SetVariable& variable : run.head.variables)
      table.add_line({run.head.run + "/" + variable.name, variable.units,
                      std::string(role_name(variable.role)),
                      variable.slow
                          ? rate / static_cast<double>(run.head.slow_step)
                          : rate,
                      variable.long_name});
  }
  return table.taken();
}

std::string set_sentence(const CardFacts& facts) {
  return fmt::format(
      "{} virtual vibrating-beam piezo gyros with thermal drift, simulated by "
      "beamgyro {} ({}) from seed {}. {}",
      facts.head.devices, facts.head.program_version, facts.head.git_revision,
      facts.head.seed, facts.description);
}

}  // namespace

std::string croissant_text(const CardFacts& facts,
                           const SetCardOptions& options,
                           const std::string& readme) {
  CardJson card;
  card["@context"] = croissant_context();
  card["@type"] = "sc:Dataset";
  card["name"] = facts.name;
  card["conformsTo"] = "http://mlcommons.org/croissant/1.0";
  card["description"] = set_sentence(facts);
  for (const auto& [key, value] :
       {std::pair{"license", &options.license}, {"url", &options.url}})
    if (!value->empty()) card[key] = *value;
  if (!options.creator.empty())
    card["creator"] = {{"@type", "sc:Organization"}, {"name", options.creator}};
  if (!options.date.empty()) card["datePublished"] = options.date;
  card["version"] = options.version;
  card["keywords"] = {"gyroscope", "thermal drift", "simulation",
                      "calibration"};
  card["isLiveDataset"] = false;
  card["distribution"] = CardJson::array();
  for (const CardFile& file : facts.files)
    card["distribution"].push_back(file_json(file));
  card["distribution"].push_back(
      file_json({kReadmeName, readme.size(), sha256(readme), "text/markdown",
                 "The data card: what the set can and cannot teach."}));
  card["recordSet"] = {splits_table(), variables_table(facts)};
  if (facts.head.devices <= kMostListedDevices)
    card["recordSet"].push_back(devices_table(facts));
  return card.dump(1) + "\n";
}

}  // namespace beamgyro::internal
