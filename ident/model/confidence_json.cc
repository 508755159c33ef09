// ident: how sure a result is, to JSON and back.
#include "ident/model/confidence_json.h"

#include <nlohmann/json.hpp>

#include "ident/model/json_pieces.h"
#include "ident/parameters/fit_options_json.h"
#include "ident/parameters/option_names.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

Json PointJson(const ProfilePoint& point) {
  Json others = Json::object();
  for (const auto& [name, value] : point.others) others[name] = NumberJson(value);
  return {{"value", NumberJson(point.value)}, {"cost", NumberJson(point.cost)}, {"others", others}};
}

Json BootstrapParametersJson(const Bootstrap& b) {
  Json rows = Json::array();
  for (size_t i = 0; i < b.names.size(); ++i) {
    rows.push_back({{"name", b.names[i]},
                    {"unit", b.units[i]},
                    {"standard_error", NumberJson(b.standard_error[i])},
                    {"interval_95", {NumberJson(b.lower95[i]), NumberJson(b.upper95[i])}}});
  }
  return rows;
}

Json StartJson(const StartDiagnostics& s) {
  return {{"condition_number", NumberJson(s.condition_number)},
          {"null_directions", NullDirectionsJson(s.null_directions)},
          {"without_effect", s.without_effect},
          {"notes", s.notes},
          {"unit_warnings", s.unit_warnings}};
}

StartDiagnostics StartFrom(const Json& json) {
  StartDiagnostics s;
  s.condition_number = NumberFrom(json.at("condition_number"));
  s.null_directions = NullDirectionsFrom(json.at("null_directions"));
  s.without_effect = json.at("without_effect").get<std::vector<std::string>>();
  s.notes = json.at("notes").get<std::vector<std::string>>();
  s.unit_warnings = json.at("unit_warnings").get<std::vector<std::string>>();
  return s;
}

Json RecordingJson(const RecordingDiagnostics& r) {
  Json outliers = Json::array();
  for (const Outlier& o : r.outliers) {
    outliers.push_back({{"frame", o.frame},
                        {"person", o.person},
                        {"error", NumberJson(o.error)},
                        {"weight", NumberJson(o.weight)}});
  }
  return {{"id", r.id},
          {"explained_percent", NumberJson(r.explained)},
          {"cost", NumberJson(r.cost)},
          {"lag1", NumberJson(r.lag1)},
          {"ljung_box", NumberJson(r.ljung_box)},
          {"ljung_box_p", NumberJson(r.ljung_box_p)},
          {"outliers", outliers}};
}

RecordingDiagnostics RecordingFrom(const Json& json) {
  RecordingDiagnostics r;
  r.id = json.at("id");
  r.explained = NumberFrom(json.at("explained_percent"));
  r.cost = NumberFrom(json.at("cost"));
  r.lag1 = NumberFrom(json.at("lag1"));
  r.ljung_box = NumberFrom(json.at("ljung_box"));
  r.ljung_box_p = NumberFrom(json.at("ljung_box_p"));
  for (const Json& o : json.at("outliers")) {
    r.outliers.push_back(
        {o.at("frame"), o.at("person"), NumberFrom(o.at("error")), NumberFrom(o.at("weight"))});
  }
  return r;
}

Json WhitenessJson(const Whiteness& w) {
  return {{"channel", w.channel},
          {"autocorrelation", NumbersJson(w.autocorrelation)},
          {"error", NumbersJson(w.error)},
          {"push", NumbersJson(w.push)},
          {"push_error", NumbersJson(w.push_error)},
          {"band", NumberJson(w.band)},
          {"mean_band", NumberJson(w.mean_band)},
          {"ljung_box", NumberJson(w.ljung_box)},
          {"ljung_box_p", NumberJson(w.ljung_box_p)}};
}

Whiteness WhitenessFrom(const Json& json) {
  Whiteness w;
  w.channel = json.at("channel");
  w.autocorrelation = NumbersFrom(json.at("autocorrelation"));
  w.error = NumbersFrom(json.at("error"));
  w.push = NumbersFrom(json.at("push"));
  w.push_error = NumbersFrom(json.at("push_error"));
  w.band = NumberFrom(json.at("band"));
  w.mean_band = NumberFrom(json.at("mean_band"));
  w.ljung_box = NumberFrom(json.at("ljung_box"));
  w.ljung_box_p = NumberFrom(json.at("ljung_box_p"));
  return w;
}

Json LeverageJson(const Leverage& l) {
  return {{"recordings", l.recordings},
          {"parameters", l.parameters},
          {"units", l.units},
          {"change", RowsJson(l.change)},
          {"in_errors", RowsJson(l.in_errors)}};
}

Leverage LeverageFrom(const Json& json) {
  Leverage l;
  l.recordings = json.at("recordings").get<std::vector<std::string>>();
  l.parameters = json.at("parameters").get<std::vector<std::string>>();
  l.units = json.at("units").get<std::vector<std::string>>();
  l.change = RowsFrom(json.at("change"));
  l.in_errors = RowsFrom(json.at("in_errors"));
  const auto whole = [&l](const std::vector<std::vector<double>>& rows) {
    return rows.size() == l.recordings.size() &&
           std::all_of(rows.begin(), rows.end(), [&l](const std::vector<double>& row) {
             return row.size() == l.parameters.size();
           });
  };
  if (!whole(l.change) || !whole(l.in_errors) || l.units.size() != l.parameters.size()) {
    throw std::runtime_error("rows of the leverage have wrong lengths");
  }
  return l;
}

ProfileClass ClassFrom(const Json& row, const std::string& key) {
  ProfileClass found;
  if (MaybeError error = ParseName(key, row.at(key).get<std::string>(), &found)) {
    throw std::runtime_error(error->ToString());
  }
  return found;
}

}  // namespace

Json ToJson(const std::vector<Profile>& profiles) {
  Json rows = Json::array();
  for (const Profile& p : profiles) {
    Json points = Json::array();
    for (const ProfilePoint& point : p.points) points.push_back(PointJson(point));
    rows.push_back(
        {{"name", p.name},
         {"unit", p.unit},
         {"estimate", NumberJson(p.estimate)},
         {"class", NameOf(p.classification)},
         {"class_by_data_alone", p.by_data_alone ? Json(NameOf(*p.by_data_alone)) : Json()},
         {"interval_95", {NumberJson(p.lower95), NumberJson(p.upper95)}},
         {"cost", NumberJson(p.cost)},
         {"threshold", NumberJson(p.threshold)},
         {"ends", {p.lower_end, p.upper_end}},
         {"points", points}});
  }
  return rows;
}

std::vector<Profile> ProfilesFromJson(const Json& json) {
  std::vector<Profile> profiles;
  for (const Json& row : json) {
    Profile p;
    p.name = row.at("name");
    p.unit = row.at("unit");
    p.estimate = NumberFrom(row.at("estimate"));
    p.classification = ClassFrom(row, "class");
    if (row.contains("class_by_data_alone") && !row.at("class_by_data_alone").is_null()) {
      p.by_data_alone = ClassFrom(row, "class_by_data_alone");
    }
    p.lower95 = NumberFrom(row.at("interval_95").at(0));
    p.upper95 = NumberFrom(row.at("interval_95").at(1));
    p.cost = NumberFrom(row.at("cost"));
    p.threshold = NumberFrom(row.at("threshold"));
    p.lower_end = row.at("ends").at(0);
    p.upper_end = row.at("ends").at(1);
    for (const Json& point : row.at("points")) {
      ProfilePoint at{NumberFrom(point.at("value")), NumberFrom(point.at("cost")), {}};
      for (const auto& [other, value] : point.at("others").items()) {
        at.others[other] = NumberFrom(value);
      }
      p.points.push_back(at);
    }
    profiles.push_back(p);
  }
  return profiles;
}

Json ToJson(const Bootstrap& b) {
  return {{"replicas", b.replicas},
          {"seed", b.seed},
          {"drawn_by", NameOf(b.drawn_by)},
          {"drawn_from", b.drawn_from},
          {"people_shared", b.people_shared},
          {"failed", b.failed},
          {"parameters", BootstrapParametersJson(b)},
          {"values", RowsJson(b.values)}};
}

Bootstrap BootstrapFromJson(const Json& json) {
  Bootstrap b;
  b.replicas = json.at("replicas");
  b.seed = json.at("seed");
  if (json.contains("drawn_by")) {  // added later; recordings were drawn before
    b.drawn_by = EnumFrom<ClusterBy>(json, "drawn_by");
    b.drawn_from = json.at("drawn_from");
    b.people_shared = json.at("people_shared");
  }
  b.failed = json.at("failed");
  for (const Json& row : json.at("parameters")) {
    b.names.push_back(row.at("name"));
    b.units.push_back(row.at("unit"));
    b.standard_error.push_back(NumberFrom(row.at("standard_error")));
    b.lower95.push_back(NumberFrom(row.at("interval_95").at(0)));
    b.upper95.push_back(NumberFrom(row.at("interval_95").at(1)));
  }
  b.values = RowsFrom(json.at("values"));
  for (const std::vector<double>& row : b.values) {
    if (row.size() != b.names.size()) throw std::runtime_error("rows of different lengths");
  }
  return b;
}

Json ToJson(const Diagnostics& d) {
  Json recordings = Json::array(), whiteness = Json::array(), trace = Json::array();
  for (const RecordingDiagnostics& r : d.recordings) recordings.push_back(RecordingJson(r));
  for (const Whiteness& w : d.whiteness) whiteness.push_back(WhitenessJson(w));
  for (const TracePoint& t : d.trace) {
    trace.push_back({{"horizon", t.horizon},
                     {"iteration", t.iteration},
                     {"cost", NumberJson(t.cost)},
                     {"gradient", NumberJson(t.gradient)}});
  }
  return {{"start", StartJson(d.start)},
          {"recordings", recordings},
          {"whiteness", whiteness},
          {"leverage", LeverageJson(d.leverage)},
          {"trace", trace}};
}

Json AdviceJson(const std::vector<Advice>& advice) {
  Json json = Json::array();
  for (const Advice& a : advice) json.push_back({{"sentence", a.sentence}, {"command", a.command}});
  return json;
}

Diagnostics DiagnosticsFromJson(const Json& json) {
  Diagnostics d;
  d.start = StartFrom(json.at("start"));
  for (const Json& r : json.at("recordings")) d.recordings.push_back(RecordingFrom(r));
  for (const Json& w : json.at("whiteness")) d.whiteness.push_back(WhitenessFrom(w));
  d.leverage = LeverageFrom(json.at("leverage"));
  for (const Json& t : json.at("trace")) {
    d.trace.push_back({t.at("horizon"), t.at("iteration"), NumberFrom(t.at("cost")),
                       NumberFrom(t.at("gradient"))});
  }
  return d;
}

std::vector<Advice> AdviceFrom(const Json& json) {
  std::vector<Advice> advice;
  for (const Json& a : json) advice.push_back({a.at("sentence"), a.at("command")});
  return advice;
}

}  // namespace pushid
