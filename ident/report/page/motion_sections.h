// ident: sections of a report that show recordings and their predictions.
#pragma once

#include "ident/report/page/build_report.h"

namespace pushid {

// The report in a few sentences, with hips of the recordings that are predicted best, in the middle
// and worst.
ReportSection LeadSection(const ReportSource& source);
// The motion of all people, to be played.
ReportSection FigureSection(const ReportSource& source);
// Each recording's motion with its prediction, bands and forces.
ReportSection MotionSection(const ReportSource& source);

}  // namespace pushid
