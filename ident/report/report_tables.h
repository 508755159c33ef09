// ident: what a result says, as tables and sentences: the terminal's report and the page show the
// same ones. Pure functions of the result; empty where there is nothing to say.
#pragma once

#include <string>

#include "ident/figures/text_table.h"
#include "ident/model/fitted_model.h"

namespace pushid {

// "97/3/0", and what priors and settling together moved the value by, in its standard errors.
std::string SharesText(const Shares& shares);
std::string PullText(const Estimate& estimate);

TextTable EstimateTable(const FitResult& result);
// For papers: symbol (TeX), parameter, unit, estimate, 95 % interval and verdict of what was
// fitted; as LaTeX with booktabs, and as Markdown.
TextTable PaperTable(const FitResult& result);
std::string LatexOf(const TextTable& table);
std::string MarkdownOf(const TextTable& table);
// Which of the free parameters the data identify: "All 7 free parameters are identified by the
// data.", or how many, and which are not and why.
std::string IdentifiedText(const FitResult& result);
// What the columns of shares and pulls mean.
std::string SharesNote();

// Whom errors and status are about: these people, or people like them.
std::string TargetText(const FitResult& result);
// How errors were estimated, and whom they are about.
std::string HowSure(const FitResult& result);

// What the feet of the model do, and why.
std::string FeetOfFit(const FitResult& result);

// c_x, c_y and gains per mass, and the convention that separates mu from Kp.
TextTable DerivedTable(const FitResult& result);
std::string ConventionText(const FitResult& result);

// Values of each unit that parameters are pooled by; only a header where nothing is pooled.
TextTable PooledTable(const FitResult& result);
// The shared values and how far units differ from them; only a header where nothing is pooled.
TextTable SpreadTable(const FitResult& result);

// Pairs of parameters that the data separate poorly.
std::string CorrelationText(const FitResult& result);

// What people do after a push, in words, and settling simulation by settling simulation.
std::string BehaviourText(const FitResult& result);
// Where lines that are pushed forwards at their first person end up; only a header where no person
// touches.
TextTable LinesTable(const FitResult& result);
TextTable BehaviourTable(const FitResult& result);

}  // namespace pushid
