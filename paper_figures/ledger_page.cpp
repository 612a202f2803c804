#include "paper_figures/ledger_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/files.h"
#include "paper_figures/anchors.h"
#include "paper_figures/number_format.h"
#include "paper_figures/templates.h"

namespace textonbench {
namespace {

using Json = nlohmann::ordered_json;

/// A class name for styles and script.
std::string css_class(ClaimVerdict verdict) {
  std::string name(verdict_name(verdict));
  std::ranges::replace(name, ' ', '-');
  return name;
}

std::string limit_in_words(double limit) { return std::isfinite(limit) ? format_number(limit) : "∞"; }

std::string expected_in_words(const ExpectedRange& range) {
  if (!std::isfinite(range.low)) return fmt::format("at most {:g}", range.high);
  if (!std::isfinite(range.high)) return fmt::format("at least {:g}", range.low);
  return fmt::format("in [{:g}, {:g}]", range.low, range.high);
}

/// "rme of rpn / rme of adsn".
std::string measure_in_words(const ClaimTest& test) {
  const auto part = [](const ClaimSelection& s) {
    constexpr std::array<std::string_view, 4> over_seeds{"", "mean over seeds of ", "deviation over seeds of ",
                                                         "least over seeds of "};
    std::string text = fmt::format("{}{}{} of {}", over_seeds.at(static_cast<std::size_t>(s.over_seeds)),
                                   s.floor ? "floor of " : "", s.metric, s.run);
    for (const auto& [key, value] : s.conditions) text += fmt::format(", {} = {}", key, to_string(value));
    return text;
  };
  if (!test.against) return part(test.measure);
  return fmt::format("{} {} {}", part(test.measure), test.combine == CombinePair::ratio ? "/" : "−",
                     part(*test.against));
}

Json row_of(const ClaimOutcome& outcome) {
  const Claim& claim = *outcome.claim;
  Json links = Json::array();
  for (const std::string& id : outcome.records) {
    links.push_back({{"href", "index.html#" + record_anchor(id)}, {"id", id}});
  }
  Json measured = nullptr;
  if (outcome.measured) {
    const Estimate& m = *outcome.measured;
    measured = {{"value", format_number(m.value)},
                {"interval", fmt::format("[{}, {}]", limit_in_words(m.low), limit_in_words(m.high))}};
  }
  return {{"id", claim.id},
          {"where", claim.where},
          {"statement", claim.statement},
          {"kind", claim.kind},
          {"paper_value", claim.paper_value},
          {"how", claim.how},
          {"caveat", or_null(claim.caveat)},
          {"note", or_null(claim.note)},
          {"test", claim.test ? Json(fmt::format("{}: expected {}", measure_in_words(*claim.test),
                                                 expected_in_words(claim.test->expect)))
                              : Json(nullptr)},
          {"verdict", verdict_name(outcome.verdict)},
          {"class", css_class(outcome.verdict)},
          {"reason", or_null(outcome.reason)},
          {"measured", measured},
          {"command", or_null(outcome.command)},
          {"has_records", !links.empty()},
          {"record_count", links.size()},
          {"records", links}};
}

Json bar_of(const std::vector<const ClaimOutcome*>& outcomes) {
  Json parts = Json::array();
  for (const ClaimVerdict verdict : all_verdicts) {
    const auto count = std::ranges::count(outcomes, verdict, &ClaimOutcome::verdict);
    if (count == 0) continue;
    parts.push_back({{"count", count}, {"verdict", verdict_name(verdict)}, {"class", css_class(verdict)}});
  }
  return parts;
}

/// Papers in the order in which they first appear.
Json papers_of(const std::vector<ClaimOutcome>& outcomes) {
  std::vector<std::pair<std::string, std::vector<const ClaimOutcome*>>> papers;
  for (const ClaimOutcome& outcome : outcomes) {
    const std::string& name = outcome.claim->paper;
    const auto known = std::ranges::find(papers, name, [](const auto& paper) { return paper.first; });
    (known == papers.end() ? papers.emplace_back(name, std::vector<const ClaimOutcome*>{}) : *known)
        .second.push_back(&outcome);
  }
  Json views = Json::array();
  for (const auto& [name, claims] : papers) {
    Json rows = Json::array();
    for (const ClaimOutcome* outcome : claims) rows.push_back(row_of(*outcome));
    views.push_back({{"title", name}, {"anchor", "p-" + anchor_text(name)}, {"bar", bar_of(claims)}, {"claims", rows}});
  }
  return views;
}

}  // namespace

std::filesystem::path ledger_page(const ResultsFolder& results) { return results.path() / "report" / "claims.html"; }

std::filesystem::path write_ledger_page(const std::vector<ClaimOutcome>& outcomes, const ResultsFolder& results) {
  std::vector<const ClaimOutcome*> all;
  all.reserve(outcomes.size());
  for (const ClaimOutcome& outcome : outcomes) all.push_back(&outcome);
  std::filesystem::path file = ledger_page(results);
  std::filesystem::create_directories(file.parent_path());
  write_atomically(file, render_template("ledger", {{"css", template_file("report.css") + template_file("ledger.css")},
                                                    {"js", template_file("ledger.js")},
                                                    {"count", outcomes.size()},
                                                    {"verdicts", bar_of(all)},
                                                    {"papers", papers_of(outcomes)}}));
  return file;
}

}  // namespace textonbench
