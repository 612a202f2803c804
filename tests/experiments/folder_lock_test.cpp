#include "experiments/folder_lock.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <optional>

#include "tests/temporary_folder.h"

namespace textonbench::folder_lock_test {

class FolderLockTest : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* folder : {"pictures", "logs", "provenance"}) {
      std::filesystem::create_directory(folder_.path() / folder);
      make(std::string(folder) + "/.draft_1_x");
      make(std::string(folder) + "/kept");
    }
  }
  void make(const std::string& name) const { std::ofstream(folder_.path() / name) << "x"; }
  bool has(const std::string& name) const { return std::filesystem::exists(folder_.path() / name); }

  TemporaryFolder folder_;
  ResultsFolder results_{folder_.path()};
};

TEST_F(FolderLockTest, TheFirstToComeRemovesDrafts) {
  const FolderLock lock(results_);
  for (const std::string folder : {"pictures", "logs", "provenance"}) {
    EXPECT_FALSE(has(folder + "/.draft_1_x")) << folder;
    EXPECT_TRUE(has(folder + "/kept")) << folder;
  }
}

TEST_F(FolderLockTest, TheDraftsOfOthersAtWorkAreLeftAlone) {
  const FolderLock first(results_);
  make("pictures/.draft_2_y");
  const FolderLock second(results_);
  EXPECT_TRUE(has("pictures/.draft_2_y"));
}

TEST_F(FolderLockTest, AChildHoldsTheLockOfItsParent) {
  std::optional<FolderLock> lock(std::in_place, results_);
  const pid_t child = fork();
  if (child == 0) {
    while (true) pause();
  }
  lock.reset();
  make("pictures/.draft_2_y");
  lock.emplace(results_);
  EXPECT_TRUE(has("pictures/.draft_2_y"));
  lock.reset();
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  lock.emplace(results_);
  EXPECT_FALSE(has("pictures/.draft_2_y"));
}

}  // namespace textonbench::folder_lock_test
