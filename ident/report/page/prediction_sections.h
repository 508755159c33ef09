// ident: sections of a report that score predictions: steps, groups, frequency response.
#pragma once

#include "ident/report/page/build_report.h"

namespace pushid {

ReportSection StepSection(const ReportSource& source);
ReportSection GroupSection(const ReportSource& source);
ReportSection FrequencySection(const ReportSource& source);

}  // namespace pushid
