// apps: fits in Python: options named as the flags, results, checks by refits, and the report's
// figures as data for matplotlib.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/python/bindings.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/names.h"
#include "ident/checks/model_checks.h"
#include "ident/parameters/json_archive.h"
#include "ident/parameters/option_table.h"
#include "ident/report/advice.h"
#include "ident/report/document.h"
#include "ident/report/page/build_report.h"
#include "ident/report/report_text.h"
#include "ident/validation/crossvalidation.h"
#include "ident/validation/experiment_design.h"
#include "ident/validation/scores_report.h"

namespace pushid {
namespace {

using Advised = std::vector<std::pair<std::string, std::string>>;

// The model with calls in its advice instead of commands.
FittedModel InCalls(const Model& model, const Advised& calls) {
  FittedModel fitted = *model.fitted;
  fitted.advice.clear();
  for (const auto& [sentence, call] : calls) fitted.advice.push_back({sentence, call});
  return fitted;
}

std::string Text(const Model& model, const Advised& calls) {
  Screen screen = ScreenOf(InCalls(model, calls));
  screen.rest = "the rest: result.details; a page: result.report; all numbers: result.json";
  return InPython(screen.ToString());
}

std::shared_ptr<const FittedTo> Data(const std::vector<SharedRecording>& recordings) {
  return std::make_shared<const FittedTo>(FittedTo{recordings, Pendulums(recordings)});
}

// Gives recordings to a model that was loaded.
void Attach(Model* model, const std::vector<SharedRecording>& recordings) {
  const std::vector<FittedRecording>& fitted = model->fitted->fit.recordings;
  auto to = Data(recordings);
  const bool same =
      std::equal(fitted.begin(), fitted.end(), to->pendulums.begin(), to->pendulums.end(),
                 [](const FittedRecording& was, const PendulumRecording& is) {
                   return was.id == is.id && was.content_hash == is.content_hash;
                 });
  if (!same) {
    Raise(Fault::kUsage, Error{"these are not the " + std::to_string(fitted.size()) +
                               " recordings that were fitted, in their order and unchanged"});
  }
  model->to = std::move(to);
}

FitSetup Setup(const GivenOptions& given) {
  return Unwrapped(FitSetup::Make(given, given), Fault::kUsage);
}

Provenance From(const GivenOptions& given, const FitOptions& options) {
  Provenance from;
  from.version = PUSHID_VERSION;
  for (const FitOptionRow& row : FitOptionRows()) {
    if (row.text) from.configuration[row.name] = row.text(options);
  }
  for (const auto& [name, value] : given) {
    from.configuration[name] = value;
    from.changed_flags.push_back(name);
  }
  return from;
}

void CheckRecordings(const std::vector<SharedRecording>& recordings) {
  if (recordings.empty()) Raise(Fault::kUsage, Error{"there are no recordings"});
  for (const SharedRecording& one : recordings) {
    if (!one->pushes.empty() || !one->ground.empty()) continue;
    Raise(Fault::kData, Error{"recording " + one->id +
                              " has no push: give one, or estimate it by "
                              "pushid.estimate_push"});
  }
  std::set<std::string> ids;
  for (const SharedRecording& one : recordings) {
    if (ids.insert(one->id).second) continue;
    Raise(Fault::kUsage, Error{"two recordings are called '" + one->id +
                               "': warnings and results would mix them up; give each its own id "
                               "(pushid.Recording(..., id=...)), and no recording twice"});
  }
}

std::shared_ptr<Model> FitModel(const std::vector<SharedRecording>& recordings,
                                const GivenOptions& given, const py::object& progress,
                                const WarningTuples& file_warnings) {
  CheckRecordings(recordings);
  const FitSetup setup = Setup(given);
  auto model = std::make_shared<Model>();
  model->to = Data(recordings);
  const std::vector<PendulumRecording>& pendulums = model->to->pendulums;
  FitOptions options = Unwrapped(setup.For(pendulums), Fault::kUsage);
  const std::vector<std::string> ignored = OptionWarnings(given, options);
  Warnings warnings;
  Check(PrepareFit(pendulums, &options, &warnings), Fault::kUsage);
  warnings.insert(warnings.begin(), ignored.begin(), ignored.end());
  Warn(warnings);
  const SolveProgress report = ProgressOf(progress);
  FittedModel fitted;
  fitted.fit = WithoutGil([&] {
    return FitAnyStance(pendulums, options, setup.OtherStances(pendulums, options), report);
  });
  FitResult& fit = fitted.fit;
  if (!fit.ok()) Raise(Fault::kFit, Error{"the fit failed: " + fit.message});
  const Warnings of_files = WarningsOf(file_warnings);
  fit.warnings.insert(fit.warnings.begin(), of_files.begin(), of_files.end());
  fitted.provenance = From(given, options);
  fitted.advice = Advise(fitted);
  model->fitted = std::make_shared<const FittedModel>(std::move(fitted));
  return model;
}

// A model without its recordings.
std::shared_ptr<Model> WithoutData(Result<FittedModel> read) {
  auto model = std::make_shared<Model>();
  model->fitted = std::make_shared<const FittedModel>(Unwrapped(std::move(read), Fault::kData));
  return model;
}

void Save(const Model& model, const std::string& path) {
  const FitResult& fit = model.fitted->fit;
  Check(WriteFittedModel(path, *model.fitted, fit.options.num_threads, fit.solve_seconds),
        Fault::kData);
}

// A report, with figures of the model's recordings if it has them. Releases the GIL.
Report ReportOf(const FittedModel& fitted, const Model& model) {
  const std::shared_ptr<const FittedTo> to = model.to;
  const JobProgress progress = JobsOf(py::none());
  const py::gil_scoped_release no_gil;
  std::vector<Recording> drawn;
  if (to) {
    for (const SharedRecording& one : to->recordings) drawn.push_back(*one);
  }
  return BuildReport(fitted, drawn, 1, progress);
}

// The page of a model from pushid-fit has commands instead of calls.
void WriteReport(const Model& model, const std::string& path, const Advised& calls) {
  Check(CheckPageName("report", path), Fault::kUsage);
  std::shared_ptr<const FittedModel> fitted = model.fitted;
  if (fitted->provenance.manifest.empty()) {
    fitted = std::make_shared<const FittedModel>(InCalls(model, calls));
  }
  Check(WriteFileAtomically(path, ToPage(ReportOf(*fitted, model))), Fault::kData);
}

// Scores as JSON text, and as the text that the programs print.
using ScoresAndText = std::pair<std::string, std::string>;

ScoresAndText EvaluateOn(const Model& model, const std::vector<SharedRecording>& recordings,
                         int observed, const std::string& forecast) {
  const IdentifiedModel identified = IdentifiedOf(model);
  const auto pendulums = Pendulums(recordings);
  if (observed > 0) Check(CheckObserved(pendulums, observed), Fault::kUsage);
  const ForecastUse use = Named<ForecastUse>("forecast", forecast);
  const Evaluation evaluation =
      WithoutGil([&] { return Evaluate(identified, pendulums, observed, UsualGroups(), use); });
  return {ToJson(evaluation).dump(), EvaluationText(evaluation, false)};
}

ScoresAndText CrossValidateAll(const std::vector<SharedRecording>& recordings,
                               const std::vector<std::pair<std::string, GivenOptions>>& candidates,
                               const std::string& scheme, int num_folds, int repeats, uint64_t seed,
                               int observed, const std::string& forecast, bool baselines,
                               int num_threads, const py::object& progress) {
  CheckRecordings(recordings);
  const auto pendulums = Pendulums(recordings);
  std::vector<Predictor> predictors;
  for (const auto& [name, given] : candidates) {
    const FitSetup setup = Setup(given);
    predictors.push_back(ModelPredictor(name, Unwrapped(setup.For(pendulums), Fault::kUsage),
                                        observed, Named<ForecastUse>("forecast", forecast)));
  }
  if (baselines) {
    for (const Baseline& baseline : Baselines(observed)) {
      predictors.push_back(BaselinePredictor(baseline, observed));
    }
  }
  const auto folds =
      Unwrapped(MakeFolds(pendulums, Named<FoldScheme>("scheme", scheme), num_folds, repeats, seed),
                Fault::kUsage);
  const JobProgress report = JobsOf(progress);
  const auto validated = WithoutGil([&] {
    std::vector<CrossValidation> all;
    for (const Predictor& predictor : predictors) {
      all.push_back(CrossValidate(pendulums, folds, predictor, num_threads, report));
    }
    return all;
  });
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const CrossValidation& one : validated) json.push_back(ToJson(one));
  return {json.dump(), CrossValidationText(validated)};
}

// (name, help, default) of every option.
py::list OptionList() {
  py::list list;
  const FitOptions defaults;
  for (const FitOptionRow& row : FitOptionRows()) {
    const bool known = row.text && !row.preset_decides;
    list.append(
        py::make_tuple(row.name, row.help,
                       known ? py::object(py::str(row.text(defaults))) : py::object(py::none())));
  }
  return list;
}

// Applies `add` to a copy of the model without the GIL, and replaces the model by the copy.
template <typename Add>
void Extend(Model* model, Add add) {
  const std::shared_ptr<const FittedTo> to = DataOf(*model);
  FittedModel extended = *model->fitted;
  const MaybeError error = WithoutGil([&] {
    MaybeError failed = add(to->pendulums, &extended);
    if (!failed) extended.advice = Advise(extended);
    return failed;
  });
  Check(error, Fault::kUsage);
  model->fitted = std::make_shared<const FittedModel>(std::move(extended));
}

using PendulumRecordings = std::vector<PendulumRecording>;

using Json = nlohmann::ordered_json;

Json PushesJson(const ExperimentDesign& design) {
  Json rows = Json::array();
  for (const DesignRow& row : design.rows) {
    Json ratios = Json::object();
    for (size_t i = 0; i < design.parameters.size(); ++i) {
      ratios[design.parameters[i].name] = NumberJson(row.error_ratio[i]);
    }
    rows.push_back({{"direction_deg", row.push.direction_deg},
                    {"acceleration", row.push.acceleration},
                    {"height", row.push.height},
                    {"duration_s", row.push.duration_s},
                    {"mass_kg", row.push.mass_kg},
                    {"sensor", row.push.sensor},
                    {"error_ratio", std::move(ratios)},
                    {"mean_error_ratio", NumberJson(row.error_ratio.back())}});
  }
  return rows;
}

std::string DesignOf(const Model& model, const std::string& parameter) {
  const std::shared_ptr<const FittedTo> to = DataOf(model);
  const std::shared_ptr<const FittedModel> fitted = model.fitted;
  Result<ExperimentDesign> design =
      WithoutGil([&] { return DesignExperiments(to->pendulums, fitted->fit); });
  Json json = {{"text", Unwrapped(DesignText(parameter, &design), Fault::kUsage)},
               {"standard_error", Json::object()},
               {"pushes", Json::array()},
               {"no_push", design.ok() ? "" : design.error().message}};
  if (design.ok()) {
    for (const Estimate& e : design.value().parameters) {
      json["standard_error"][e.name] = NumberJson(e.standard_error);
    }
    json["pushes"] = PushesJson(design.value());
  }
  return json.dump();
}

// A list of fields(item).
template <typename Item, typename Fields>
py::list Tuples(const std::vector<Item>& items, Fields fields) {
  py::list list;
  for (const Item& item : items) list.append(fields(item));
  return list;
}

py::dict DictOf(const Chart& chart) {
  using namespace py::literals;
  const auto tuple = [](const auto&... fields) { return py::make_tuple(fields...); };
  return py::dict(
      "title"_a = chart.title, "x_label"_a = chart.x_label, "y_label"_a = chart.y_label,
      "lines"_a =
          Tuples(chart.lines, [&](const ChartLine& l) { return tuple(l.points, l.look, l.dots); }),
      "bands"_a =
          Tuples(chart.bands, [&](const ChartBand& b) { return tuple(b.lower, b.upper, b.look); }),
      "lanes"_a =
          Tuples(chart.lanes, [&](const ChartLane& l) { return tuple(l.name, l.bars, l.look); }),
      "bars"_a =
          Tuples(chart.bars, [&](const ChartBar& b) { return tuple(b.row, b.from, b.to, b.look); }),
      "levels"_a = chart.levels, "marks"_a = chart.marks,
      "x_range"_a = tuple(chart.x_from, chart.x_to), "y_range"_a = tuple(chart.y_from, chart.y_to),
      "logarithmic"_a = tuple(chart.logarithmic_x, chart.logarithmic_y), "bare_y"_a = chart.bare_y,
      "y_categories"_a = chart.y_categories, "y_notes"_a = chart.y_notes,
      "x_categories"_a = chart.x_categories, "cells"_a = chart.cells,
      "full_cell"_a = chart.full_cell);
}

// {name: {caption, legend, panels}}, in the report's order.
py::dict Figures(const Model& model) {
  using namespace py::literals;
  const Report report = ReportOf(*model.fitted, model);
  py::dict figures;
  for (const ReportFigure* figure : FiguresOf(report)) {
    const auto entry = [](const LegendEntry& e) { return py::make_tuple(e.name, e.look); };
    figures[py::str(figure->name)] =
        py::dict("caption"_a = figure->caption, "legend"_a = Tuples(figure->figure.legend, entry),
                 "panels"_a = Tuples(figure->figure.panels,
                                     [](const Chart& panel) { return DictOf(panel); }));
  }
  return figures;
}

}  // namespace

std::shared_ptr<const FittedTo> DataOf(const Model& model) {
  if (model.to) return model.to;
  Raise(Fault::kUsage, Error{"this result was loaded or unpickled without its recordings; give "
                             "them by result.attach(recordings)"});
}

IdentifiedModel IdentifiedOf(const Model& model) { return ModelOf(model.fitted->fit); }

void BindFits(py::module_* module) {
  py::class_<Model, std::shared_ptr<Model>>(*module, "Model")
      .def("json", [](const Model& m) { return ToJson(*m.fitted, RunInfo()).dump(); })
      .def("text", &Text)
      .def("details", [](const Model& m,
                         const Advised& calls) { return InPython(DetailsText(InCalls(m, calls))); })
      .def_property_readonly("converged", [](const Model& m) { return m.fitted->fit.converged; })
      .def_property_readonly("warnings",
                             [](const Model& m) { return InPython(m.fitted->fit.warnings); })
      .def_property_readonly("advice",
                             [](const Model& m) {
                               Advised advice;
                               for (const Advice& a : m.fitted->advice) {
                                 advice.emplace_back(InPython(a.sentence),
                                                     CommandFor(m.fitted->provenance, a.command));
                               }
                               return advice;
                             })
      .def("save", &Save)
      .def("report", &WriteReport)
      .def("attach", &Attach)
      .def("evaluate", &EvaluateOn);
  module->def("fit", &FitModel);
  module->def("load", [](const std::string& path) { return WithoutData(ReadFittedModel(path)); });
  module->def("from_json", [](const std::string& text) {
    return WithoutData(FittedModelFromJson(nlohmann::ordered_json::parse(text), "pickle"));
  });
  module->def("crossvalidate", &CrossValidateAll);
  module->def("options", &OptionList);
  module->def("profile", [](Model* model, const std::vector<std::string>& names, int num_threads,
                            const py::object& progress) {
    Extend(model, [&](const PendulumRecordings& recordings, FittedModel* fitted) {
      return AddProfiles(recordings, names, num_threads, JobsOf(progress), fitted);
    });
  });
  module->def("bootstrap", [](Model* model, int replicas, uint64_t seed, int num_threads,
                              const py::object& progress) {
    Extend(model, [&](const PendulumRecordings& recordings, FittedModel* fitted) {
      const BootstrapOptions options{replicas, seed, num_threads};
      return AddBootstrap(recordings, options, JobsOf(progress), fitted);
    });
  });
  module->def("horizon_check", [](Model* model, int num_threads, const py::object& progress) {
    Extend(model, [&](const PendulumRecordings& recordings, FittedModel* fitted) {
      AddHorizonCheck(recordings, num_threads, JobsOf(progress), fitted);
      return MaybeError();
    });
  });
  module->def("learn_forecasts", [](Model* model, int num_threads) {
    Extend(model, [&](const PendulumRecordings& recordings, FittedModel* fitted) {
      return AddForecasts(recordings, num_threads, fitted);
    });
  });
  module->def("design", &DesignOf);
  module->def("figures", &Figures);
  // Looks are classes of this style sheet, or declarations of their own.
  module->def("svg_style", &SvgStyle);
  module->attr("level_look") = kLimitLook;
  module->attr("mark_look") = kMarkLook;
}

}  // namespace pushid
