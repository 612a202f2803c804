#include "paper_figures/report.h"

#include <gmock/gmock.h>

#include <regex>
#include <set>

#include "paper_figures/picture_store.h"
#include "paper_figures/report_context.h"
#include "tests/paper_figures/fixture.h"

namespace textonbench::report_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class ReportTest : public FiguresTest {
 protected:
  std::string write() {
    const ExemplarCatalog exemplars(TEXTONBENCH_SOURCE_DIR);
    const std::filesystem::path page = write_report({{config_, plan_}}, exemplars, results_);
    EXPECT_EQ(page, folder_ / "report" / "index.html");
    return read_file(page);
  }

  /// Two exemplars, a panel, a table and a chart; one failure, one refusal, one run without a record.
  void fill_everything() {
    for (const char* exemplar : {"ring", "white_noise"}) {
      Record record = record_of(plan_run("rpn", exemplar), 0.5);
      add_picture(record, "exemplar", {8, 6}, 1, 0, 0);
      add_picture(record, "sample", {8, 6}, 0, exemplar[0] == 'r' ? 1.0F : 0.5F, 0);
      results_.append(record);
    }
    results_.append(unsuccessful(plan_run("other", "ring"), "failed", "crashed & burned"));
    results_.append(unsuccessful(plan_run("other", "white_noise"), "refused", "not periodic"));
    plan_run("late", "ring");
    plan_.missing.push_back({"wall1004", "from the authors' archive", 3});
    add_figure("panel", "panel", {"rpn"}).lists["columns"] = {
        {{"run", std::string("rpn")}, {"picture", std::string("exemplar")}, {"label", std::string("Input")}},
        {{"run", std::string("rpn")}, {"picture", std::string("sample")}, {"label", std::string("RPN")}}};
    add_figure("numbers", "table", {"rpn", "other"});
    add_figure("errors", "chart", {"rpn", "other"}).options["metric"] = std::string("rme");
    add_figure("late", "table", {"late"});
  }
};

/// Elements of HTML that never close.
bool is_void(const std::string& tag) {
  static const std::set<std::string> tags{"meta", "img", "input", "br", "link", "hr"};
  return tags.contains(tag);
}

/// The first place where tags do not nest, or nothing.
std::string nesting_error(std::string html) {
  html = std::regex_replace(html, std::regex("<script>[^]*?</script>|<style>[^]*?</style>"), "");
  std::vector<std::string> open;
  const std::regex tag(R"re(<(/?)([a-zA-Z][a-zA-Z0-9]*)((?:[^<>"']|"[^"]*"|'[^']*')*)>)re");
  for (std::sregex_iterator match(html.begin(), html.end(), tag), end; match != end; ++match) {
    const std::string name = (*match)[2], rest = (*match)[3];
    if ((*match)[1].length() > 0) {
      if (open.empty() || open.back() != name) return "unexpected " + match->str();
      open.pop_back();
    } else if (!is_void(name) && (rest.empty() || rest.back() != '/')) {
      open.push_back(name);
    }
  }
  return open.empty() ? "" : "never closed: " + open.back();
}

std::vector<std::string> all_matches(const std::string& text, const char* pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match) {
    found.push_back((*match)[1]);
  }
  return found;
}

TEST_F(ReportTest, HasAPlaceForEveryRunAndEveryLinkHasItsPlace) {
  fill_everything();
  const std::string page = write();
  const std::vector<std::string> ids = all_matches(page, "\\sid=[\"']([^\"']+)[\"']");
  const std::set<std::string> places(ids.begin(), ids.end());
  EXPECT_EQ(places.size(), ids.size()) << "an id stands twice";
  for (const PlannedRun& run : plan_.runs) EXPECT_TRUE(places.contains("r-" + run.id)) << run.id;
  for (const std::string& target : all_matches(page, "href=[\"']#([^\"']+)[\"']")) {
    EXPECT_TRUE(places.contains(target)) << target;
  }
  for (const std::string& target : all_matches(page, "data-same=\"([^\"]+)\"")) {
    EXPECT_TRUE(places.contains(target)) << target;
  }
}

TEST_F(ReportTest, IsWellFormedAndSelfContained) {
  fill_everything();
  const std::string page = write();
  EXPECT_EQ(nesting_error(page), "");
  EXPECT_THAT(all_matches(page, "(?:src|href|action|data)=[\"'](https?:[^\"']*|//[^\"']*)[\"']"), IsEmpty());
  EXPECT_THAT(page, AllOf(Not(HasSubstr("@import")), Not(HasSubstr("url(")), Not(HasSubstr("{{"))));
  EXPECT_THAT(page, Not(HasSubstr(folder_.string())));
  EXPECT_EQ(all_matches(page, "(data:image/png;base64,)[A-Za-z0-9+/]").size(), 3U) << "each picture once";
  EXPECT_EQ(page, write()) << "the same records give the same page";
}

TEST_F(ReportTest, ListsFailuresRefusalsAndGaps) {
  fill_everything();
  const std::string page = write();
  EXPECT_THAT(page, HasSubstr("1 config of 1 method on 2 exemplars: 5 runs, 2 recorded, 1 failed, 1 refused, 1 not run "
                              "yet. 1 exemplar is not on this machine"));
  EXPECT_THAT(page, AllOf(HasSubstr("crashed &amp; burned"), HasSubstr("not periodic"), HasSubstr("wall1004"),
                          HasSubstr("from the authors&apos; archive")));
  EXPECT_THAT(page, HasSubstr("This figure was not made: 1 of its 1 records is missing: late on ring"));
  EXPECT_THAT(page, HasSubstr("Abacus")) << "the machine";
}

TEST_F(ReportTest, EscapesHostileText) {
  const std::string hostile = "</script><img src=x onerror=alert(1)>\"'&";
  Record record = record_of(plan_run(hostile, hostile), 0.5);
  add_picture(record, "sample", {8, 6}, 1, 0, 0);
  record["command"] = "rm '" + hostile + "'";
  results_.append(record);
  results_.append(unsuccessful(plan_run(hostile, "ring"), "failed", hostile));
  config_.title = config_.source = config_.description = hostile;
  FigureTable& panel = add_figure("panel", "panel", {hostile});
  panel.lists["columns"] = {{{"run", hostile}, {"picture", std::string("sample")}, {"label", hostile}}};
  panel.title = panel.caption = hostile;
  add_figure("numbers", "table", {hostile}).title = hostile;
  add_figure("errors", "chart", {hostile}).options["metric"] = std::string("rme");
  plan_.missing.push_back({hostile, hostile, 3});
  const std::string page = write();
  EXPECT_THAT(page, Not(HasSubstr("<img src=x")));
  EXPECT_THAT(page, HasSubstr("&lt;/script&gt;&lt;img src=x onerror=alert(1)&gt;&quot;&apos;&amp;"));
  EXPECT_EQ(nesting_error(page), "");
  EXPECT_EQ(all_matches(page, "(</script>)").size(), 1U);
}

TEST_F(ReportTest, WorksWithoutAnyRecord) {
  plan_run("rpn", "ring");
  EXPECT_EQ(nesting_error(write()), "");
  plan_.runs.clear();
  EXPECT_THAT(write(), HasSubstr("no runs"));
}

TEST_F(ReportTest, ShowsBenchmarksWithTheirCounters) {
  fill_everything();
  write_atomically(folder_ / "benchmarks.json", R"json({
    "context": {"num_cpus": 2, "mhz_per_cpu": 3000, "cpu_scaling_enabled": false, "library_build_type": "release",
                "host_name": "secret", "date": "2022-01-01", "caches": [{"type": "Data", "level": 1, "size": 32768}]},
    "benchmarks": [
      {"name": "rpn/1024", "run_name": "rpn/1024", "run_type": "iteration", "iterations": 10, "real_time": 90.0,
       "cpu_time": 80.0, "time_unit": "ms", "ratio_to_floor": 1.5},
      {"name": "rpn/1024_median", "run_name": "rpn/1024", "run_type": "aggregate", "aggregate_name": "median",
       "real_time": 70.0, "cpu_time": 60.0, "time_unit": "ms", "ratio_to_floor": 1.18},
      {"name": "adsn/4096/iterations:9/manual_time", "run_name": "adsn/4096/iterations:9/manual_time", "run_type": "iteration", "real_time": 5.0, "cpu_time": 4.0,
       "time_unit": "s"}]})json");
  const std::string page = write();
  EXPECT_THAT(page, AllOf(HasSubstr("Ratio to floor"), HasSubstr("1.180"), HasSubstr("70.00 ms"), HasSubstr("5.000 s"),
                          HasSubstr("2 processors at 3000 MHz")));
  EXPECT_THAT(page, AllOf(Not(HasSubstr("90.00 ms")), Not(HasSubstr("secret"))));
  EXPECT_THAT(page, AllOf(HasSubstr(">adsn/4096<"), Not(HasSubstr("manual_time"))));
  EXPECT_THAT(speed_html("{\"context\": 3"), HasSubstr("not what Google Benchmark writes"));
  EXPECT_EQ(speed_html(""), "");
}

TEST_F(ReportTest, ShrinksTheWindowUntilPicturesFit) {
  Record record = record_of(plan_run("rpn", "ring"), 0.5);
  Image noise({512, 512}, 3);
  std::uint32_t state = 1;
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 512; ++y) {
      for (float& value : noise.row(c, y)) {
        state = state * 1664525U + 1013904223U;
        value = static_cast<float>(state >> 24) / 255.0F;
      }
    }
  }
  write_image(noise, folder_ / "draft.png");
  const Record picture{{"file", results_.keep_picture(folder_ / "draft.png")}, {"width", 512}, {"height", 512}};
  PictureStore store(results_);
  const std::string key = store.show(picture, PictureFit::window).value();
  EXPECT_EQ(store.fitting_side(std::size_t{2} << 20), 0);
  // 300 KiB of base64 are 225 KiB of pixels that do not compress: a square of 277.
  EXPECT_EQ(store.fitting_side(std::size_t{300} << 10), 272);
  const std::string page = store.embed("<img data-picture=\"" + key + "\"><img data-picture=\"" + key + "\">", 256);
  EXPECT_THAT(page, AllOf(HasSubstr("<img id=\"" + key + "\" src=\"data:image/png;base64,"),
                          HasSubstr("<img data-same=\"" + key + "\" width=\"256\" height=\"256\">")));
  EXPECT_LT(page.size(), std::size_t{320} << 10);
  EXPECT_FALSE(store.show({{"file", "pictures/gone.png"}, {"width", 1}, {"height", 1}}, PictureFit::window));
}

TEST(Base64, EncodesTheExamplesOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

}  // namespace textonbench::report_test
