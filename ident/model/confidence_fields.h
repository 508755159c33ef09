// ident: the entries of what was found out about a fit: diagnostics, profiles, bootstrap
// (parameters/json_archive.h).
#pragma once

#include <algorithm>
#include <tuple>
#include <vector>

#include "ident/model/model_fields.h"

namespace pushid {

template <class Archive>
void Fields(Archive& a, Finding& f) {
  PUSHID_FIELDS(a, f, kind, recording, about, value);
}

template <class Archive>
void Fields(Archive& a, StartDiagnostics& s) {
  PUSHID_FIELDS(a, s, condition_number, null_directions, without_effect, notes);
  if (a.Has("findings")) a("findings", s.findings);  // older files have none
}

template <class Archive>
void Fields(Archive& a, Outlier& o) {
  PUSHID_FIELDS(a, o, frame, person, error, weight);
}

template <class Archive>
void Fields(Archive& a, RecordingDiagnostics& r) {
  a("id", r.id);
  a("explained_percent", r.explained);
  PUSHID_FIELDS(a, r, cost, lag1, ljung_box, ljung_box_p, outliers);
}

template <class Archive>
void Fields(Archive& a, Whiteness& w) {
  PUSHID_FIELDS(a, w, channel, autocorrelation, error, push, push_error, band, mean_band, ljung_box,
                ljung_box_p);
}

template <class Archive>
void Fields(Archive& a, Leverage& l) {
  PUSHID_FIELDS(a, l, recordings, parameters, units, change, in_errors);
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
  PUSHID_FIELDS(a, t, horizon, iteration, cost, gradient);
}

template <class Archive>
void Fields(Archive& a, AssumptionTest& t) {
  PUSHID_FIELDS(a, t, name, unit, stated, wanted, error, t, p, moves);
}

template <class Archive>
void Fields(Archive& a, PartTest& t) {
  PUSHID_FIELDS(a, t, parameter, part, t, p);
}

template <class Archive>
void Fields(Archive& a, MotionTest& t) {
  PUSHID_FIELDS(a, t, quantity, unit, difference, error, t, p);
}

template <class Archive>
void Fields(Archive& a, ModelVerdict& v) {
  a.Written("fails", [&] { return v.fails(); });
  PUSHID_FIELDS(a, v, not_checked, freedom, p_assumptions, p_parts, p_motion, assumptions, parts);
  a("motion", v.motion.tests);
  a("explained", v.motion.explained);
  a("of_pushes", v.of_pushes);
  if (a.Has("none_identified", !v.none_identified.empty())) {
    a("none_identified", v.none_identified);
  }
}

template <class Archive>
void Fields(Archive& a, Diagnostics& d) {
  PUSHID_FIELDS(a, d, start, recordings, whiteness, leverage, trace);
}

template <class Archive>
void Fields(Archive& a, Advice& advice) {
  PUSHID_FIELDS(a, advice, sentence, command);
}

template <class Archive>
void Fields(Archive& a, ProfilePoint& p) {
  PUSHID_FIELDS(a, p, value, cost, others);
}

template <class Archive>
void Fields(Archive& a, Profile& p) {
  PUSHID_FIELDS(a, p, name, unit, estimate);
  a("class", p.classification);
  a.OrNull("class_by_data_alone", p.by_data_alone);
  a.Pair("interval_95", p.lower95, p.upper95);
  PUSHID_FIELDS(a, p, cost, threshold);
  a.Pair("ends", p.lower_end, p.upper_end);
  a("points", p.points);
}

template <class Archive>
void Fields(Archive& a, Bootstrap& b) {
  PUSHID_FIELDS(a, b, replicas, seed);
  if (a.Has("drawn_by")) {  // added later; recordings were drawn before
    PUSHID_FIELDS(a, b, drawn_by, drawn_from, people_shared);
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
void Fields(Archive& a, HorizonFit& f) {
  a("frames", f.frames);
  a("values", f.value);
  a("standard_errors", f.standard_error);
  a("failure", f.failure);
}

template <class Archive>
void Fields(Archive& a, HorizonCheck& c) {
  a.Rows("parameters", std::tie(c.parameters, c.units, c.value, c.standard_error),
         [&c](auto& row, size_t i) {
           row("name", c.parameters[i]);
           row("unit", c.units[i]);
           row("value", c.value[i]);
           row("standard_error", c.standard_error[i]);
         });
  a("refits", c.refits);
  for (const HorizonFit& fit : c.refits) {
    a.Check(fit.value.size() == fit.standard_error.size() &&
                (fit.value.empty() || fit.value.size() == c.parameters.size()),
            "refits of different lengths");
  }
}

}  // namespace pushid
