#include "experiments/record.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <set>

#include "experiments/provenance.h"
#include "tests/temporary_folder.h"

namespace textonbench::record_test {

using testing::AllOf;
using testing::HasSubstr;

Record make_record(const std::string& id, const std::string& status = "ok", const std::string& reason = "") {
  Record record = {{"schema", 1}, {"id", id}, {"status", status}};
  if (!reason.empty()) record["reason"] = reason;
  return record;
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class RecordTest : public testing::Test {
 protected:
  void write_records_file(const std::string& text) const { std::ofstream(records_file()) << text; }
  std::filesystem::path records_file() const { return temporary_.path() / "records.jsonl"; }

  TemporaryFolder temporary_;
  ResultsFolder results_{temporary_.path()};
};

TEST_F(RecordTest, ReadsBackWhatWasAppendedInOrder) {
  EXPECT_TRUE(results_.read().records.empty());
  results_.append(make_record("a"));
  results_.append(make_record("b", "failed", "two\nlines and \"quotes\""));
  const ReadRecords read = results_.read();
  ASSERT_EQ(read.records.size(), 2U);
  EXPECT_TRUE(read.bad_lines.empty());
  EXPECT_EQ(read.records[0], make_record("a"));
  EXPECT_EQ(read.records[1]["reason"], "two\nlines and \"quotes\"");
}

TEST_F(RecordTest, AcceptsAReasonThatIsNotUtf8) {
  results_.append(make_record("a", "failed", "\xff\xfe"));
  EXPECT_EQ(results_.read().records.size(), 1U);
}

TEST_F(RecordTest, TellsBadLinesAndKeepsTheRest) {
  write_records_file(
      "{\"schema\":1,\"id\":\"a\",\"status\":\"ok\"}\n"
      "{\"schema\":1,\"id\":\"b\",\n"
      "[1]\n"
      "{\"schema\":2,\"id\":\"c\",\"status\":\"ok\"}\n"
      "{\"schema\":1,\"status\":\"ok\"}\n"
      "{\"schema\":1,\"id\":\"d\",\"status\":\"ok\"}\n");
  const ReadRecords read = results_.read();
  ASSERT_EQ(read.records.size(), 2U);
  EXPECT_EQ(read.records[1]["id"], "d");
  ASSERT_EQ(read.bad_lines.size(), 4U);
  EXPECT_EQ(read.bad_lines[0].line, 2U);
  EXPECT_THAT(read.bad_lines[0].reason, HasSubstr("not JSON"));
  EXPECT_EQ(read.bad_lines[1].line, 3U);
  EXPECT_THAT(read.bad_lines[1].reason, HasSubstr("object"));
  EXPECT_THAT(read.bad_lines[2].reason, HasSubstr("schema"));
  EXPECT_THAT(read.bad_lines[3].reason, HasSubstr("\"id\""));
}

TEST_F(RecordTest, ALineCutShortByACrashSwallowsNothing) {
  const std::string cut = "{\"schema\":1,\"id\":\"a\",\"status\":\"ok\"}\n{\"schema\":1,\"id\":\"b\",\"sta";
  write_records_file(cut);
  results_.append(make_record("c"));
  const ReadRecords read = results_.read();
  ASSERT_EQ(read.records.size(), 2U);
  EXPECT_EQ(read.records[0]["id"], "a");
  EXPECT_EQ(read.records[1]["id"], "c");
  ASSERT_EQ(read.bad_lines.size(), 1U);
  EXPECT_EQ(read.bad_lines[0].line, 2U);
  EXPECT_THAT(content_of(records_file()), testing::StartsWith(cut + "\n"));
}

TEST_F(RecordTest, ACompleteLastLineWithoutNewlineStillCounts) {
  write_records_file("{\"schema\":1,\"id\":\"a\",\"status\":\"ok\"}");
  results_.append(make_record("b"));
  EXPECT_EQ(results_.read().records.size(), 2U);
}

// A file size limit stands for the full disk: the write is cut at the limit in the same way.
TEST_F(RecordTest, AFullDiskLeavesTheFileAsItWas) {
  results_.append(make_record("a"));
  const std::string before = content_of(records_file());
  const auto previous_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit previous{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &previous), 0);
  rlimit limit = previous;
  limit.rlim_cur = before.size() + 10;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  std::string message;
  try {
    results_.append(make_record("b"));
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &previous), 0);
  std::signal(SIGXFSZ, previous_handler);
  EXPECT_THAT(message, AllOf(HasSubstr("records.jsonl"), HasSubstr("File too large"), HasSubstr("kept")));
  EXPECT_EQ(content_of(records_file()), before);
  results_.append(make_record("b"));
  EXPECT_EQ(results_.read().records.size(), 2U);
}

TEST_F(RecordTest, AFullDeviceIsNamedWithItsReason) {
  std::filesystem::create_symlink("/dev/full", records_file());
  EXPECT_THROW(results_.append(make_record("a")), std::runtime_error);
}

TEST_F(RecordTest, AFolderThatCannotBeMadeIsNamed) {
  std::ofstream(temporary_.path() / "file") << "x";
  try {
    const ResultsFolder below_a_file(temporary_.path() / "file" / "results");
    FAIL() << "expected an exception";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("file/results"), HasSubstr("Not a directory")));
  }
}

TEST_F(RecordTest, ProcessesThatAppendAtOnceLoseNothing) {
  constexpr int writers = 4, records_each = 25;
  // Longer than a page, so that an interleaving would show.
  const std::string padding(10000, 'x');
  std::vector<pid_t> children;
  for (int w = 0; w < writers; ++w) {
    const pid_t pid = fork();
    ASSERT_GE(pid, 0);
    if (pid == 0) {
      for (int i = 0; i < records_each; ++i) {
        results_.append(make_record(std::to_string(w) + "_" + std::to_string(i), "ok", padding));
      }
      _exit(0);
    }
    children.push_back(pid);
  }
  for (const pid_t pid : children) {
    int status = 0;
    waitpid(pid, &status, 0);
    EXPECT_EQ(status, 0);
  }
  const ReadRecords read = results_.read();
  EXPECT_TRUE(read.bad_lines.empty());
  std::set<std::string> ids;
  for (const Record& record : read.records) ids.insert(record["id"].get<std::string>());
  EXPECT_EQ(read.records.size(), std::size_t{writers} * records_each);
  EXPECT_EQ(ids.size(), std::size_t{writers} * records_each);
}

TEST_F(RecordTest, PicturesAreKeptByContent) {
  const auto keep = [&](const std::string& bytes) {
    const std::filesystem::path draft = temporary_.path() / "draft.png";
    std::ofstream(draft, std::ios::binary) << bytes;
    std::string name = results_.keep_picture(draft);
    EXPECT_FALSE(std::filesystem::exists(draft));
    return name;
  };
  const std::string first = keep("one"), again = keep("one"), other = keep("two");
  EXPECT_EQ(first, "pictures/" + sha256("one") + ".png");
  EXPECT_EQ(first, again);
  EXPECT_NE(first, other);
  EXPECT_EQ(content_of(temporary_.path() / other), "two");
}

TEST(LatestByIdTest, PrefersTheLastSuccessOverLaterFailures) {
  const std::vector<Record> records{make_record("a", "ok", "1"),     make_record("a", "ok", "2"),
                                    make_record("a", "failed", "3"), make_record("b", "failed", "4"),
                                    make_record("b", "failed", "5"), make_record("c", "failed", "6"),
                                    make_record("c", "refused", "7")};
  const auto latest = latest_by_id(records, {"c", "a", "missing", "b"});
  ASSERT_EQ(latest.size(), 4U);
  EXPECT_EQ((*latest[0])["reason"], "7");
  EXPECT_EQ((*latest[1])["reason"], "2");
  EXPECT_FALSE(latest[2].has_value());
  EXPECT_EQ((*latest[3])["reason"], "5");
}

TEST(LatestByIdTest, ARefusalElsewhereLeavesASuccessHere) {
  const std::vector<Record> records{make_record("a", "ok", "1"),      make_record("a", "refused", "2"),
                                    make_record("b", "refused", "3"), make_record("b", "failed", "4"),
                                    make_record("c", "refused", "5"), make_record("c", "ok", "6")};
  const auto latest = latest_by_id(records, {"a", "b", "c"});
  EXPECT_EQ((*latest[0])["reason"], "1");
  EXPECT_EQ((*latest[1])["reason"], "3");
  EXPECT_EQ((*latest[2])["reason"], "6");
}

}  // namespace textonbench::record_test
