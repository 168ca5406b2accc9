// The figures of a report, each made where the results have what it needs and the experiment asks for it.
#pragma once

#include <optional>
#include <vector>

#include "tracer/report/page.h"

namespace copse::report {

/// Cost, trace speed and times to image over the idealised sah, bars grouped by scene (figure 4 of the paper).
std::optional<Figure> relativeFigure(const Results& results);
/// Build time and cost against k-means iterations (figure 5).
std::optional<Figure> iterationsFigure(const Results& results);
/// Where the build's time goes: k-means alone (figure 6), then all builders.
std::optional<Figure> phasesFigure(const Results& results);
/// Build time against trace speed, with those that no other beats in both.
std::optional<Figure> scatterFigure(const Results& results);
/// The same of build time against cost for combinations of k, p and i.
std::optional<Figure> parametersFigure(const Results& results);
/// Build time against the number of triangles.
std::optional<Figure> scalingFigure(const Results& results);
/// Trace speed by kind of ray.
std::optional<Figure> raysFigure(const Results& results);
/// Each method over lbvh, here against in the paper.
std::optional<Figure> agreementFigure(const Results& results);

/// All of the above, in the order of the page.
std::vector<Figure> figuresOf(const Results& results);

/// A name for files: letters, digits, dashes.
std::string slug(const std::string& name);

}  // namespace copse::report
