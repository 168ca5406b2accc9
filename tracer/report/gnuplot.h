// Runs gnuplot, a program of its own that is looked for when it is needed. Without it there are scripts and tables.
#pragma once

#include <string>
#include <vector>

#include "tracer/report/page.h"

namespace copse::report {

/// Writes `folder`/figures/NAME.gp and NAME.csv of every panel and, where gnuplot is installed, draws NAME.svg and
/// fills in Panel::svg. Gives back why figures are missing, or "". A script that gnuplot takes too long over is given
/// up.
std::string drawAll(std::vector<Figure>& figures, const std::string& folder);

/// A drawing as a part of a page: no prolog, its ids made its own, and a text for those who cannot see it.
std::string inlined(const std::string& svg, const Panel& panel);

}  // namespace copse::report
