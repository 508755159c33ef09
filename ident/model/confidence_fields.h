// ident: the entries of what was found out about a fit: diagnostics, profiles, bootstrap, refits
// (parameters/json_archive.h).
#pragma once

#include <algorithm>
#include <tuple>
#include <vector>

#include "ident/model/model_fields.h"

namespace pushid {

template <class Archive>
void Fields(Archive& a, Finding& f) {
  a("kind", f.kind);
  a("recording", f.recording);
  a("about", f.about);
  a("value", f.value);
}

template <class Archive>
void Fields(Archive& a, StartDiagnostics& s) {
  a("condition_number", s.condition_number);
  a("null_directions", s.null_directions);
  a("without_effect", s.without_effect);
  a("notes", s.notes);
  if (a.Has("findings")) a("findings", s.findings);  // older files have none
}

template <class Archive>
void Fields(Archive& a, Outlier& o) {
  a("frame", o.frame);
  a("person", o.person);
  a("error", o.error);
  a("weight", o.weight);
}

template <class Archive>
void Fields(Archive& a, RecordingDiagnostics& r) {
  a("id", r.id);
  a("explained_percent", r.explained);
  a("cost", r.cost);
  a("lag1", r.lag1);
  a("ljung_box", r.ljung_box);
  a("ljung_box_p", r.ljung_box_p);
  a("outliers", r.outliers);
}

template <class Archive>
void Fields(Archive& a, Whiteness& w) {
  a("channel", w.channel);
  a("autocorrelation", w.autocorrelation);
  a("error", w.error);
  a("push", w.push);
  a("push_error", w.push_error);
  a("band", w.band);
  a("mean_band", w.mean_band);
  a("ljung_box", w.ljung_box);
  a("ljung_box_p", w.ljung_box_p);
}

template <class Archive>
void Fields(Archive& a, Leverage& l) {
  a("recordings", l.recordings);
  a("parameters", l.parameters);
  a("units", l.units);
  a("change", l.change);
  a("in_errors", l.in_errors);
  const auto whole = [&l](const std::vector<std::vector<double>>& rows) {
    return rows.size() == l.recordings.size() &&
           std::all_of(rows.begin(), rows.end(), [&l](const std::vector<double>& row) {
             return row.size() == l.parameters.size();
           });
  };
  a.Check(whole(l.change) && whole(l.in_errors) && l.units.size() == l.parameters.size(),
          "rows of the leverage have wrong lengths");
}

template <class Archive>
void Fields(Archive& a, TracePoint& t) {
  a("horizon", t.horizon);
  a("iteration", t.iteration);
  a("cost", t.cost);
  a("gradient", t.gradient);
}

template <class Archive>
void Fields(Archive& a, AssumptionTest& t) {
  a("name", t.name);
  a("unit", t.unit);
  a("stated", t.stated);
  a("wanted", t.wanted);
  a("error", t.error);
  a("t", t.t);
  a("p", t.p);
  a("moves", t.moves);
}

template <class Archive>
void Fields(Archive& a, PartTest& t) {
  a("parameter", t.parameter);
  a("part", t.part);
  a("t", t.t);
  a("p", t.p);
}

template <class Archive>
void Fields(Archive& a, MotionTest& t) {
  a("quantity", t.quantity);
  a("unit", t.unit);
  a("difference", t.difference);
  a("error", t.error);
  a("t", t.t);
  a("p", t.p);
}

template <class Archive>
void Fields(Archive& a, ModelVerdict& v) {
  a.Written("fails", [&] { return v.fails(); });
  a("not_checked", v.not_checked);
  a("freedom", v.freedom);
  a("p_assumptions", v.p_assumptions);
  a("p_parts", v.p_parts);
  a("p_motion", v.p_motion);
  a("assumptions", v.assumptions);
  a("parts", v.parts);
  a("motion", v.motion.tests);
  a("explained", v.motion.explained);
  a("of_pushes", v.of_pushes);
}

template <class Archive>
void Fields(Archive& a, Diagnostics& d) {
  a("start", d.start);
  a("recordings", d.recordings);
  a("whiteness", d.whiteness);
  a("leverage", d.leverage);
  a("trace", d.trace);
}

template <class Archive>
void Fields(Archive& a, Advice& advice) {
  a("sentence", advice.sentence);
  a("command", advice.command);
}

template <class Archive>
void Fields(Archive& a, ProfilePoint& p) {
  a("value", p.value);
  a("cost", p.cost);
  a("others", p.others);
}

template <class Archive>
void Fields(Archive& a, Profile& p) {
  a("name", p.name);
  a("unit", p.unit);
  a("estimate", p.estimate);
  a("class", p.classification);
  a.OrNull("class_by_data_alone", p.by_data_alone);
  a.Pair("interval_95", p.lower95, p.upper95);
  a("cost", p.cost);
  a("threshold", p.threshold);
  a.Pair("ends", p.lower_end, p.upper_end);
  a("points", p.points);
}

template <class Archive>
void Fields(Archive& a, Bootstrap& b) {
  a("replicas", b.replicas);
  a("seed", b.seed);
  if (a.Has("drawn_by")) {  // added later; recordings were drawn before
    a("drawn_by", b.drawn_by);
    a("drawn_from", b.drawn_from);
    a("people_shared", b.people_shared);
  }
  a("failed", b.failed);
  a.Rows("parameters", std::tie(b.names, b.units, b.standard_error, b.lower95, b.upper95),
         [&b](auto& row, size_t i) {
           row("name", b.names[i]);
           row("unit", b.units[i]);
           row("standard_error", b.standard_error[i]);
           row.Pair("interval_95", b.lower95[i], b.upper95[i]);
         });
  a("values", b.values);
  for (const std::vector<double>& row : b.values) {
    a.Check(row.size() == b.names.size(), "rows of different lengths");
  }
}

template <class Archive>
void Fields(Archive& a, RefitRow& r) {
  a("source", r.source);
  a("name", r.name);
  a("values", r.value);
  a("standard_errors", r.standard_error);
  a("failure", r.failure);
  a("frames", r.frames);
}

template <class Archive>
void Fields(Archive& a, RefitTable& t) {
  a.Rows("parameters", std::tie(t.parameters, t.units, t.value, t.standard_error),
         [&t](auto& row, size_t i) {
           row("name", t.parameters[i]);
           row("unit", t.units[i]);
           row("value", t.value[i]);
           row("standard_error", t.standard_error[i]);
         });
  a("refits", t.rows);
  for (const RefitRow& row : t.rows) {
    for (const std::vector<double>* numbers : {&row.value, &row.standard_error}) {
      a.Check(numbers->empty() || numbers->size() == t.parameters.size(),
              "refits of different lengths");
    }
  }
}

}  // namespace pushid
