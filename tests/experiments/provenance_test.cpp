#include "experiments/provenance.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/metrics/metric.h"
#include "methods/method.h"
#include "tests/temporary_folder.h"

namespace textonbench::provenance_test {

using testing::HasSubstr;
using testing::MatchesRegex;

// FIPS 180-4 examples.
TEST(Sha256Test, AgreesWithTheStandard) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256Test, OfAFileIsThatOfItsBytes) {
  const TemporaryFolder folder;
  // Longer than one read, and not a multiple of it.
  const std::string bytes(200001, '\x80');
  std::ofstream(folder.path() / "file", std::ios::binary) << bytes;
  EXPECT_EQ(sha256_of_file(folder.path() / "file"), sha256(bytes));
}

TEST(Sha256Test, NamesAFileThatCannotBeRead) {
  const TemporaryFolder folder;
  EXPECT_THROW(sha256_of_file(folder.path() / "missing"), std::invalid_argument);
  EXPECT_THROW(sha256_of_file(folder.path()), std::invalid_argument);
}

TEST(ProvenanceTest, TellsCodeMachineAndLibraries) {
  const nlohmann::ordered_json p = provenance();
  std::vector<std::string> keys;
  for (const auto& [key, value] : p.items()) keys.push_back(key);
  EXPECT_THAT(keys,
              testing::ElementsAre("version", "git_commit", "git_dirty", "git_diff", "compiler", "flags", "build_type",
                                   "cpu", "simd", "cores", "threads", "os", "libraries", "fft_plans"));
  EXPECT_THAT(p["version"].get<std::string>(), MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
  EXPECT_THAT(p["git_commit"].get<std::string>(), MatchesRegex("[0-9a-f]{40}|unknown"));
  EXPECT_TRUE(p["git_dirty"].is_boolean() || p["git_dirty"] == "unknown");
  EXPECT_EQ(p["git_diff"],
            std::string(source_diff()).empty() ? nullptr : nlohmann::ordered_json(sha256(source_diff())));
  EXPECT_THAT(p["simd"].get<std::string>(), testing::AnyOf("avx512f", "avx2", "default"));
  EXPECT_THAT(p["flags"].get<std::string>(), HasSubstr("-ffp-contract=off"));
  EXPECT_GE(p["cores"].get<int>(), 1);
  EXPECT_GE(p["threads"].get<int>(), 1);
  for (const char* library : {"eigen", "fftw", "openimageio", "tbb", "fmt"}) {
    EXPECT_THAT(p["libraries"][library].get<std::string>(), testing::ContainsRegex("[0-9]")) << library;
  }
}

TEST(ProvenanceTest, EveryMethodAndMetricHasAVersion) {
  for (const MethodEntry& method : method_catalog()) {
    EXPECT_THAT(std::string(method_version(method.name)), MatchesRegex("[0-9a-f]{16}")) << method.name;
  }
  for (const MetricEntry& metric : metric_catalog()) {
    const bool may_lack_source = metric.level == MetricLevel::cost || metric.level == MetricLevel::frame;
    EXPECT_TRUE(may_lack_source || !metric.source.empty()) << metric.name;
    if (metric.source.empty()) continue;
    EXPECT_THAT(std::string(source_version(fmt::format("experiments/metrics/{}", metric.source))),
                MatchesRegex("[0-9a-f]{16}"))
        << metric.name;
  }
  EXPECT_THROW(source_version("experiments/runner"), std::invalid_argument);
  EXPECT_THROW(method_version("rp"), std::invalid_argument);
}

/// Sets an environment variable for the time of a test.
class ScopedVariable {
 public:
  ScopedVariable(const char* name, const std::string& value) : name_(name) {
    if (const char* previous = std::getenv(name)) previous_ = previous;
    setenv(name, value.c_str(), 1);
  }
  ScopedVariable(const ScopedVariable&) = delete;
  ScopedVariable& operator=(const ScopedVariable&) = delete;
  ~ScopedVariable() {
    if (previous_) {
      setenv(name_, previous_->c_str(), 1);
    } else {
      unsetenv(name_);
    }
  }

 private:
  const char* name_;
  std::optional<std::string> previous_;
};

TEST(HomeFolderTest, IsTheOneThatTheVariableNames) {
  const ScopedVariable home("TEXTONBENCH_HOME", TEXTONBENCH_SOURCE_DIR);
  EXPECT_EQ(home_folder(), TEXTONBENCH_SOURCE_DIR);
}

TEST(HomeFolderTest, AVariableThatNamesAnotherFolderIsAnError) {
  const TemporaryFolder folder;
  const ScopedVariable home("TEXTONBENCH_HOME", folder.path().string());
  try {
    home_folder();
    FAIL() << "expected an exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::AllOf(HasSubstr(folder.path().string()), HasSubstr("configs/exemplars.toml")));
  }
}

/// cmake/write_build_info.cmake on a small source tree of its own.
class BuildInfoTest : public testing::Test {
 protected:
  void SetUp() override {
    write("methods/base/image.h", "int i();\n");
    write("methods/base/pixels.cpp", "#include \"methods/base/image.h\"\n");
    write("methods/spectral/a.cpp", "#include <map>\n\n#include \"methods/base/image.h\"\n");
    write("methods/spectral/b.cpp", "int b;\n");
    write("experiments/metrics/m.cpp", "#include \"experiments/runner.h\"\n");
    write("experiments/execute.cpp", "#include \"methods/base/image.h\"\n");
    write("experiments/procedural_exemplars.cpp", "int p;\n");
    write("experiments/runner.h", "int r();\n");
    write("experiments/runner.cpp", "int r;\n");
  }

  void write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = folder_.path() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }

  /// The text after `name = "` in the header that the script writes, under the environment `prefix`.
  std::string value_of(const std::string& name, const std::string& prefix = "") const {
    const std::filesystem::path header = folder_.path() / "build_info.h";
    const std::string command = prefix + " $(command -v cmake) -D SOURCE=" + folder_.path().string() +
                                " -D OUTPUT=" + header.string() +
                                " -D VERSION=1.2.3 -D COMPILER=c -D FLAGS=f -D BUILD_TYPE=b -P " +
                                TEXTONBENCH_SOURCE_DIR + "/cmake/write_build_info.cmake";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    std::ifstream in(header);
    const std::string start = name + " = \"";
    for (std::string line; std::getline(in, line);) {
      const std::size_t at = line.find(start);
      if (at != std::string::npos) return line.substr(at + start.size(), line.rfind('"') - at - start.size());
    }
    return {};
  }

  std::string text_of(const std::string& name) const {
    std::ifstream in(folder_.path() / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  TemporaryFolder folder_;
};

TEST_F(BuildInfoTest, ASourcesVersionFollowsWhatItIncludes) {
  const std::vector<std::string> sources{"methods/spectral/a", "methods/spectral/b", "experiments/metrics/m",
                                         "experiments/execute", "experiments/procedural_exemplars"};
  const auto versions = [&] {
    value_of("version");
    const std::string header = text_of("build_info.h");
    std::map<std::string, std::string> found;
    for (const std::string& source : sources) {
      const std::string start = "{\"" + source + "\", \"";
      const std::size_t at = header.find(start);
      found[source] = at == std::string::npos ? "none" : header.substr(at + start.size(), 16);
    }
    return found;
  };
  std::map<std::string, std::string> before = versions();
  for (const auto& [source, version] : before) EXPECT_THAT(version, MatchesRegex("[0-9a-f]{16}")) << source;
  const auto changed_by = [&](const std::string& file, const std::string& text) {
    write(file, text);
    std::map<std::string, std::string> after = versions();
    std::vector<std::string> changed;
    for (const std::string& source : sources) {
      if (after[source] != before[source]) changed.push_back(source);
    }
    before = after;
    return changed;
  };
  using testing::ElementsAre;
  EXPECT_THAT(changed_by("methods/spectral/b.cpp", "int other;\n"), ElementsAre("methods/spectral/b"));
  EXPECT_THAT(changed_by("methods/base/image.h", "long i();\n"),
              ElementsAre("methods/spectral/a", "experiments/execute"));
  EXPECT_THAT(changed_by("methods/base/pixels.cpp", "#include \"methods/base/image.h\"\nint other;\n"),
              ElementsAre("methods/spectral/a", "experiments/execute"))
      << "a source whose first include is a header defines what that declares";
  EXPECT_THAT(changed_by("experiments/metrics/m.cpp", "int other;\n"), ElementsAre("experiments/metrics/m"));
  EXPECT_THAT(changed_by("experiments/runner.h", "int other;\n"), testing::IsEmpty());
  EXPECT_THAT(changed_by("methods/catalog.cpp", "#include \"methods/spectral/a.h\"\n"), testing::IsEmpty());
}

TEST_F(BuildInfoTest, AnUnchangedHeaderIsNotTouched) {
  value_of("version");
  const auto before = std::filesystem::last_write_time(folder_.path() / "build_info.h");
  EXPECT_EQ(value_of("version"), "1.2.3");
  EXPECT_EQ(std::filesystem::last_write_time(folder_.path() / "build_info.h"), before);
}

TEST_F(BuildInfoTest, WorksOutsideACheckout) {
  EXPECT_EQ(value_of("git_commit"), "unknown");
  EXPECT_EQ(value_of("git_state"), "unknown");
}

TEST_F(BuildInfoTest, TellsTheCommitAndWhetherFilesDiffer) {
  const std::string git = "git -C " + folder_.path().string() + " -c user.name=t -c user.email=t@example.org ";
  if (std::system((git + "init -q").c_str()) != 0) GTEST_SKIP() << "git is not installed";
  EXPECT_EQ(value_of("git_commit"), "unknown") << "a checkout without a commit";
  write(".gitignore", "build_info.h\n");
  ASSERT_EQ(std::system((git + "add -A").c_str()), 0);
  ASSERT_EQ(std::system((git + "commit -q -m first").c_str()), 0);
  EXPECT_THAT(value_of("git_commit"), MatchesRegex("[0-9a-f]{40}"));
  EXPECT_EQ(value_of("git_state"), "clean");
  write("experiments/runner.cpp", "int other;\n");
  EXPECT_EQ(value_of("git_state"), "dirty");
  write("methods/new.cpp", "const char* quoted = R\"(a;b)\";\n");
  value_of("git_state");
  const std::string header = text_of("build_info.h");
  EXPECT_THAT(header, testing::AllOf(HasSubstr("\n-int r;\n+int other;\n"), HasSubstr("+++ b/methods/new.cpp\n"),
                                     HasSubstr("\n+const char* quoted = R\"(a;b)\";\n")))
      << "sources that are not added yet are told as well";
  EXPECT_EQ(value_of("git_commit", "PATH=/nowhere"), "unknown") << "git is not installed";
}

}  // namespace textonbench::provenance_test
