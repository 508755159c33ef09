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
  PUSHID_FIELDS(a, e, name, value, standard_error, standard_error_naive);
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
  PUSHID_FIELDS(a, e, unit, status);
}

template <class Archive>
void Fields(Archive& a, Combination& c) {
  PUSHID_FIELDS(a, c, name, value, standard_error);
  a.Pair("interval_95", c.lower95, c.upper95);
  QuantileField(a, &c.quantile);
  a.Optional("these_people", c.these);
  a("unit", c.unit);
}

template <class Archive>
void Fields(Archive& a, ContrastRow& r) {
  PUSHID_FIELDS(a, r, name, first, second, difference);
  a.Pair("interval_95", r.lower95, r.upper95);
  PUSHID_FIELDS(a, r, p, p_holm);
  a.Optional("effect", r.effect);
  PUSHID_FIELDS(a, r, unit, status);
}

template <class Archive>
void Fields(Archive& a, Contrast& c) {
  PUSHID_FIELDS(a, c, label, first, second);
  a("people_first", c.only_first);
  a("people_second", c.only_second);
  a("people_both", c.both);
  a("rows", c.rows);
}

template <class Archive>
void Fields(Archive& a, NullDirection& n) {
  PUSHID_FIELDS(a, n, parameters, coefficients, identified, sentence);
}

template <class Archive>
void Fields(Archive& a, SettlingDemand& s) {
  PUSHID_FIELDS(a, s, binds, contradicted);
  if (a.Has("unmet")) a("unmet", s.unmet);
  PUSHID_FIELDS(a, s, rise, free_seconds);
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
  PUSHID_FIELDS(a, u, sigma, freedom, too_few_clusters, condition_number);
  a.Written("fitted", [&] {
    std::vector<std::string> names;
    for (const Estimate& e : u.estimates) names.push_back(e.name);
    return names;
  });
  a("covariance_fitted_scale", u.covariance);
  PUSHID_FIELDS(a, u, correlation, null_directions);
  if (a.Has("held_directions")) a("held_directions", u.held_directions);
  if (a.Has("settling")) a("settling", u.settling);
}

template <class Archive>
void Fields(Archive& a, SubjectParameters& s) {
  PUSHID_FIELDS(a, s, mass_kg, pooled);
}

// The solve.

}  // namespace pushid
