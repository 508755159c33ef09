// apps: --figures_out: the figures and tables of a report as files for papers.
#pragma once

#include "datasets/files/error.h"
#include "ident/model/fitted_model.h"
#include "ident/report/page/document.h"

namespace pushid {

bool FiguresAsked();

// Before anything is computed: flags that make no sense, a folder with other things in it, or no
// program that makes PDF and PNG of SVG.
MaybeError CheckFigureFlags();

// The folder as a whole, or nothing of it.
MaybeError WriteFigures(const FittedModel& model, const Report& report);

}  // namespace pushid
