// Charts drawn by gnuplot, made reproducible and readable by mouse.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace textonbench {

/// Runs gnuplot on the script, in the script's own folder and without the user's settings. Throws std::runtime_error
/// naming the Debian package when gnuplot is not installed, and with gnuplot's exit status when it fails.
void run_gnuplot(const std::filesystem::path& script);

/// What the mouse shows over a point, and the record that the point comes from.
struct PointNote {
  std::string record;
  std::string text;
};

/// gnuplot's SVG with its hypertext points (labels "#0", "#1", … that index `notes`) turned into links that carry a
/// <title>, and without what gnuplot says of itself. Throws std::runtime_error unless every note found its point.
std::string annotated_svg(const std::string& svg, const std::vector<PointNote>& notes);

/// An annotated SVG as part of the report: no XML declaration, points lead to "#r-<record>", ids start with `prefix`.
std::string linked_svg(const std::string& svg, const std::string& prefix);

/// A cairo PDF with its creation date blanked, so that the same chart is the same bytes.
std::string undated_pdf(std::string pdf);

/// Text between single quotes of a gnuplot script: quotes doubled, control characters made spaces.
std::string gnuplot_quoted(const std::string& text);

/// Escaped for XML text and attributes.
std::string xml_escaped(const std::string& text);

}  // namespace textonbench
