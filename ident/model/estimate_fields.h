// ident: the entries of estimates and their errors in a model's file (parameters/json_archive.h).
#pragma once

#include <string>

#include "ident/model/fitted_model.h"
#include "ident/parameters/json_archive.h"

namespace pushid {

template <class Archive>
void Fields(Archive& a, Interval& i) {
  a("standard_error", i.standard_error);
  a.Pair("interval_95", i.lower, i.upper);
}

// Models of older versions have Student's quantile everywhere.
template <class Archive>
void QuantileField(Archive& a, double* quantile) {
  if (a.Has("quantile")) {
    a("quantile", *quantile);
  } else if (a.Has("freedom")) {
    double freedom = 1.0;
    a("freedom", freedom);
    *quantile = StudentQuantile95(freedom);
  }
}

template <class Archive>
void Fields(Archive& a, Estimate& e) {
  // Models written before shares were computed say nothing of them, nor of degrees of freedom.
  const bool shares = a.Has("shares");
  a("name", e.name);
  a("value", e.value);
  a("standard_error", e.standard_error);
  a("standard_error_naive", e.standard_error_naive);
  a.Pair("interval_95", e.lower95, e.upper95);
  if (shares) {
    a("freedom", e.freedom);
    QuantileField(a, &e.quantile);
    a.Group("shares", [&](auto& g) {
      g("data", e.shares.data);
      g("prior", e.shares.prior);
      g("settling", e.shares.settling);
    });
    a.Group("pull", [&](auto& g) {
      g("prior", e.shares.prior_pull);
      g("settling", e.shares.settling_pull);
    });
  }
  if (a.Has("total", e.total.has_value())) {
    TotalError& total = e.total ? *e.total : e.total.emplace();
    a.Group("total", [&](auto& g) {
      g("standard_error", total.error);
      g.Pair("interval_95", total.lower95, total.upper95);
    });
  }
  a.Optional("these_people", e.these);
  a("unit", e.unit);
  a("status", e.status);
}

template <class Archive>
void Fields(Archive& a, Combination& c) {
  a("name", c.name);
  a("value", c.value);
  a("standard_error", c.standard_error);
  a.Pair("interval_95", c.lower95, c.upper95);
  QuantileField(a, &c.quantile);
  a.Optional("these_people", c.these);
  a("unit", c.unit);
}

template <class Archive>
void Fields(Archive& a, ContrastRow& r) {
  a("name", r.name);
  a("first", r.first);
  a("second", r.second);
  a("difference", r.difference);
  a.Pair("interval_95", r.lower95, r.upper95);
  a("p", r.p);
  a("p_holm", r.p_holm);
  a.Optional("effect", r.effect);
  a("unit", r.unit);
  a("status", r.status);
}

template <class Archive>
void Fields(Archive& a, Contrast& c) {
  a("label", c.label);
  a("first", c.first);
  a("second", c.second);
  a("people_first", c.only_first);
  a("people_second", c.only_second);
  a("people_both", c.both);
  a("rows", c.rows);
}

template <class Archive>
void Fields(Archive& a, NullDirection& n) {
  a("parameters", n.parameters);
  a("coefficients", n.coefficients);
  a("identified", n.identified);
  a("sentence", n.sentence);
}

template <class Archive>
void Fields(Archive& a, SettlingDemand& s) {
  a("binds", s.binds);
  a("contradicted", s.contradicted);
  if (a.Has("unmet")) a("unmet", s.unmet);
  a("rise", s.rise);
  a("free_seconds", s.free_seconds);
}

// All but the estimates, which stand at the top of the file.
template <class Archive>
void Fields(Archive& a, Uncertainty& u) {
  a.Via(
      "clustered_by", [&] { return u.clustered ? NameOf(u.clustered_by) : std::string("none"); },
      [&](const std::string& name) {
        u.clustered = name != "none";
        if (u.clustered) a("clustered_by", u.clustered_by);
      });
  if (a.Has("two_way")) a("two_way", u.two_way);
  a("clusters", u.num_clusters);
  if (a.Has("people")) {
    a("people", u.num_people);
    a("about_people_like_them", u.about_people_like_them);
  }
  a("residuals", u.num_residuals);
  if (a.Has("full_hessian")) a("full_hessian", u.full_hessian);
  a("sigma", u.sigma);
  a("freedom", u.freedom);
  a("too_few_clusters", u.too_few_clusters);
  a("condition_number", u.condition_number);
  a.Written("fitted", [&] {
    std::vector<std::string> names;
    for (const Estimate& e : u.estimates) names.push_back(e.name);
    return names;
  });
  a("covariance_fitted_scale", u.covariance);
  a("correlation", u.correlation);
  a("null_directions", u.null_directions);
  if (a.Has("held_directions")) a("held_directions", u.held_directions);
  if (a.Has("settling")) a("settling", u.settling);
}

template <class Archive>
void Fields(Archive& a, SubjectParameters& s) {
  a("mass_kg", s.mass_kg);
  a("pooled", s.pooled);
}

// The solve.

}  // namespace pushid
