// apps: the report's figures as data, for matplotlib.
#include "apps/python/bindings.h"
#include "ident/report/page/build_report.h"
#include "ident/report/page/document.h"

namespace pushid {
namespace {

py::dict DictOf(const Chart& chart) {
  py::list lines, bands, lanes, bars, labels;
  for (const ChartLine& line : chart.lines) {
    lines.append(py::make_tuple(line.points, line.look, line.dots));
  }
  for (const ChartBand& band : chart.bands) {
    bands.append(py::make_tuple(band.lower, band.upper, band.look));
  }
  for (const ChartLane& lane : chart.lanes) {
    lanes.append(py::make_tuple(lane.name, lane.bars, lane.look));
  }
  for (const ChartBar& bar : chart.bars) {
    bars.append(py::make_tuple(bar.row, bar.from, bar.to, bar.look));
  }
  for (const ChartLabel& label : chart.labels) {
    labels.append(py::make_tuple(label.x, label.y, label.text));
  }
  py::dict dict;
  dict["title"] = chart.title;
  dict["x_label"] = chart.x_label;
  dict["y_label"] = chart.y_label;
  dict["lines"] = lines;
  dict["bands"] = bands;
  dict["lanes"] = lanes;
  dict["bars"] = bars;
  dict["labels"] = labels;
  dict["is_map"] = chart.is_map;
  dict["levels"] = chart.levels;
  dict["marks"] = chart.marks;
  dict["x_range"] = py::make_tuple(chart.x_from, chart.x_to);
  dict["y_range"] = py::make_tuple(chart.y_from, chart.y_to);
  dict["logarithmic"] = py::make_tuple(chart.logarithmic_x, chart.logarithmic_y);
  dict["bare_y"] = chart.bare_y;
  dict["y_categories"] = chart.y_categories;
  dict["y_notes"] = chart.y_notes;
  dict["x_categories"] = chart.x_categories;
  dict["cells"] = chart.cells;
  dict["full_cell"] = chart.full_cell;
  return dict;
}

// {name: {caption, legend, panels}}, in the report's order.
py::dict Figures(const Model& model) {
  const Report report = ReportOf(*model.fitted, model);
  py::dict figures;
  for (const ReportFigure* figure : FiguresOf(report)) {
    py::list legend, panels;
    for (const LegendEntry& entry : figure->figure.legend) {
      legend.append(py::make_tuple(entry.name, entry.look));
    }
    for (const Chart& panel : figure->figure.panels) panels.append(DictOf(panel));
    py::dict parts;
    parts["caption"] = figure->caption;
    parts["legend"] = legend;
    parts["panels"] = panels;
    figures[py::str(figure->name)] = parts;
  }
  return figures;
}

}  // namespace

Report ReportOf(const FittedModel& fitted, const Model& model) {
  const std::shared_ptr<const FittedTo> to = model.to;
  BuildReportOptions options;
  options.progress = JobsOf(py::none());
  const py::gil_scoped_release no_gil;
  const auto drawn = to ? Copies(to->recordings) : std::vector<Recording>();
  return BuildReport(fitted, drawn, options);
}

void BindFigures(py::module_* module) {
  module->def("figures", &Figures);
  // Looks are classes of this style sheet, or declarations of their own.
  module->def("svg_style", &SvgStyle);
  module->attr("level_look") = kLimitLook;
  module->attr("mark_look") = kMarkLook;
}

}  // namespace pushid
