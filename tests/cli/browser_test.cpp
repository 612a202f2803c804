// The report as a reader meets it: in a browser, by mouse. Skipped where Chromium is not installed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <regex>

#include "tests/cli/program.h"
#include "tests/temporary_folder.h"

namespace textonbench::browser_test {

using testing::HasSubstr;
using testing::Not;

/// What the pages do for a reader, done by script; the outcome is told in attributes of <body>.
constexpr const char* reader = R"(<script>
"use strict";
addEventListener("error", (event) => document.body.dataset.error = event.message);
addEventListener("securitypolicyviolation", (event) => document.body.dataset.error = event.violatedDirective);
addEventListener("load", () => {
  const told = document.body.dataset;
  const shown = () => [...document.querySelectorAll("details.record")].filter((record) => !record.hidden).length;
  const filter = document.getElementById("record-filter");
  told.all = shown();
  filter.value = "adsn";
  filter.dispatchEvent(new Event("input"));
  told.filtered = shown();
  filter.value = "";
  filter.dispatchEvent(new Event("input"));
  const table = document.querySelector("table.sortable");
  const numbers = () => [...table.tBodies].map((body) => Number(body.rows[0].cells[1].dataset.sort));
  const sorter = table.querySelectorAll("thead .sorter")[1];
  const sorted = (sign) => numbers().every((value, i, all) => i == 0 || sign * all[i - 1] <= sign * value);
  told.rows = numbers().length;
  sorter.click();
  told.rising = sorted(1);
  sorter.click();
  told.falling = sorted(-1);
  const link = table.querySelector('tbody td a[href^="#r-"]');
  told.number = link.textContent.split("±")[0].trim();
  link.click();
  setTimeout(() => {
    const record = document.querySelector("details.record.target");
    told.open = record.open;
    told.repeated = [...record.querySelectorAll("td")].some((cell) => cell.textContent.startsWith(told.number));
    told.command = record.querySelector(".command code").textContent;
    document.querySelector(".panel .zoom").click();
    told.viewer = document.getElementById("viewer").open;
    told.done = true;
  }, 100);
});
</script>)";

/// Claims: a verdict button and the filter hide rows, and a record's link leads to the report.
constexpr const char* claims_reader = R"(<script>
"use strict";
addEventListener("error", (event) => document.body.dataset.error = event.message);
addEventListener("load", () => {
  const told = document.body.dataset;
  const shown = () => [...document.querySelectorAll("tr.claim")].filter((row) => row.offsetParent !== null);
  told.all = shown().length;
  const button = document.querySelector("button.verdict.not-run");
  button.click();
  told.unrun = shown().every((row) => row.dataset.verdict === "not-run") && shown().length > 0;
  button.click();
  const filter = document.getElementById("claim-filter");
  filter.value = "Rayleigh";
  filter.dispatchEvent(new Event("input"));
  told.found = shown().map((row) => row.id).join(" ");
  told.done = true;
});
</script>)";

std::string chromium() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    if (std::system(("command -v " + std::string(name) + " >/dev/null 2>&1").c_str()) == 0) return name;
  }
  return "";
}

struct Visit {
  std::string page;  ///< the document after its scripts have run
  std::string console;
  std::string attribute(const std::string& name) const {
    const std::size_t body = page.find("<body");
    std::smatch match;
    const std::string tag = page.substr(body, page.find('>', body) - body + 1);
    return std::regex_search(tag, match, std::regex("data-" + name + "=\"([^\"]*)\"")) ? match[1].str() : "";
  }
};

Visit visit(const std::string& browser, const std::filesystem::path& page, const std::filesystem::path& folder) {
  const std::string command =
      "cd '" + folder.string() + "' && HOME='" + folder.string() + "' timeout 120 " + browser +
      " --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run --disable-background-networking "
      "--disable-component-update --disable-sync --enable-logging=stderr --user-data-dir='" +
      (folder / "profile").string() + "' --virtual-time-budget=5000 --dump-dom 'file://" + page.string() +
      "' >dom.html 2>console.txt";
  EXPECT_EQ(std::system(command.c_str()), 0) << content_of(folder / "console.txt");
  return {content_of(folder / "dom.html"), content_of(folder / "console.txt")};
}

TEST(Report, WorksInABrowser) {
  const std::string browser = chromium();
  if (browser.empty()) GTEST_SKIP() << "needs Chromium: apt-get install chromium";
  const TemporaryFolder folder;
  const Surroundings surroundings{folder.path()};
  std::ofstream(folder.path() / "small.toml") << R"(
title = "Small"
source = "test"
[[runs]]
name = "both"
method = ["rpn", "adsn"]
exemplars = ["ring"]
samples = 2
metrics = ["mean_error", "rme"]
pictures = ["exemplar", "sample"]
[[figures]]
name = "numbers"
kind = "table"
title = "Numbers"
caption = "Two methods."
runs = ["both"]
[[figures]]
name = "pictures"
kind = "panel"
title = "Pictures"
caption = "An input and a sample."
runs = ["both"]
columns = [{run = "both", picture = "exemplar", label = "Input", method = "rpn"}, {run = "both", picture = "sample", label = "RPN", method = "rpn"}]
)";
  ASSERT_EQ(run_program({"run", "small.toml"}, surroundings).status, 0);
  const Outcome written = run_program({"report", "small.toml"}, surroundings);
  ASSERT_EQ(written.status, 0) << written.err;
  const std::filesystem::path report = folder.path() / "results" / "report";
  std::string page = content_of(report / "index.html");
  page.insert(page.rfind("</body>"), reader);
  std::ofstream(report / "read.html") << page;

  const Visit seen = visit(browser, report / "read.html", folder.path());
  EXPECT_THAT(seen.console, Not(HasSubstr("CONSOLE")));
  EXPECT_EQ(seen.attribute("error"), "");
  ASSERT_EQ(seen.attribute("done"), "true") << seen.console;
  EXPECT_EQ(seen.attribute("all"), "2");
  EXPECT_EQ(seen.attribute("filtered"), "1");
  EXPECT_EQ(seen.attribute("rows"), "2");
  EXPECT_EQ(seen.attribute("rising"), "true");
  EXPECT_EQ(seen.attribute("falling"), "true");
  EXPECT_EQ(seen.attribute("open"), "true");
  EXPECT_EQ(seen.attribute("repeated"), "true") << seen.attribute("number");
  EXPECT_THAT(seen.attribute("command"), HasSubstr("textonbench measure"));
  EXPECT_EQ(seen.attribute("viewer"), "true");

  std::string ledger = content_of(report / "claims.html");
  ledger.insert(ledger.rfind("</body>"), claims_reader);
  std::ofstream(report / "read_claims.html") << ledger;
  const Visit claims = visit(browser, report / "read_claims.html", folder.path());
  EXPECT_THAT(claims.console, Not(HasSubstr("CONSOLE")));
  EXPECT_EQ(claims.attribute("error"), "");
  ASSERT_EQ(claims.attribute("done"), "true") << claims.console;
  EXPECT_GE(std::stoi(claims.attribute("all")), 163);
  EXPECT_EQ(claims.attribute("unrun"), "true");
  EXPECT_THAT(claims.attribute("found"), HasSubstr("S03"));

  // The same page with a broken script is caught.
  std::ofstream(report / "broken.html") << page.replace(page.rfind("</body>"), 0, "<script>missing();</script>");
  const Visit broken = visit(browser, report / "broken.html", folder.path());
  EXPECT_THAT(broken.console, HasSubstr("CONSOLE"));
}

}  // namespace textonbench::browser_test
