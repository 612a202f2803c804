#include "experiments/exemplars.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "experiments/config.h"
#include "experiments/procedural_exemplars.h"
#include "tests/experiments/exemplar_home.h"

namespace textonbench::exemplars_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

template <class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

class ExemplarsTest : public testing::Test {
 protected:
  ExemplarCatalog catalog() const { return ExemplarCatalog(home_.path()); }

  const ExemplarHome home_;
  const DataVariable data_{home_.data()};
};

TEST_F(ExemplarsTest, KnowsWhatIsHere) {
  const ExemplarCatalog all = catalog();
  const ExemplarInfo& grass = all.find("grass");
  EXPECT_TRUE(grass.available);
  EXPECT_EQ(grass.file, home_.grass());
  EXPECT_EQ(grass.source, "Debian meadow-data");
  EXPECT_EQ(grass.licence, "CC0-1.0");
  EXPECT_EQ(exemplar_sha256(grass), sha256_of_file(home_.grass()));
  const Exemplar loaded = load_exemplar(grass);
  EXPECT_EQ(loaded.name, "grass");
  EXPECT_EQ(loaded.pixels.extent(), (Extent{24, 16}));
  EXPECT_EQ(loaded.sha256, exemplar_sha256(grass));
}

TEST_F(ExemplarsTest, TellsHowToGetWhatIsNotHere) {
  const ExemplarCatalog all = catalog();
  EXPECT_EQ(message_of([&] { all.find("sand"); }),
            "exemplar \"sand\" is not available here: apt-get install beach-data");
  EXPECT_EQ(message_of([&] { all.find("paper"); }),
            "exemplar \"paper\" is not available here: take it from the archive");
  EXPECT_FALSE(all.look_up("paper").available);
  EXPECT_TRUE(all.look_up("paper").file.empty());
  EXPECT_EQ(message_of([&] { load_exemplar(all.look_up("paper")); }),
            "exemplar \"paper\" is not available here: take it from the archive");
}

TEST_F(ExemplarsTest, AnUnknownNameIsRefusedWithTheNearest) {
  EXPECT_THAT(message_of([&] { catalog().find("gras"); }),
              HasSubstr("unknown exemplar \"gras\" (did you mean \"grass\"?)"));
}

TEST_F(ExemplarsTest, FindsByTag) {
  EXPECT_THAT(catalog().tagged("default"),
              ElementsAre("grass", "sand", "white_noise", "ring", "oriented_lobe", "power_law"));
  EXPECT_THAT(catalog().tagged("paper"), ElementsAre("paper", "paper_2"));
  EXPECT_THAT(catalog().tagged("none"), IsEmpty());
}

TEST_F(ExemplarsTest, TakesTheRightFileFromTheUsersFolder) {
  std::filesystem::copy(home_.paper(), home_.data() / "paper.png");
  const ExemplarCatalog all = catalog();
  const ExemplarInfo& paper = all.find("paper");
  EXPECT_EQ(paper.file, home_.data() / "paper.png");
  EXPECT_EQ(paper.source, "The paper's archive");
  EXPECT_EQ(load_exemplar(paper).sha256, paper.expected_sha256);
}

TEST_F(ExemplarsTest, NeverTakesAWrongPictureForAKnownOne) {
  ExemplarHome::write_picture(home_.data() / "paper.png", 7);
  const ExemplarCatalog all = catalog();
  EXPECT_FALSE(all.look_up("paper").available);
  EXPECT_THAT(message_of([&] { all.find("paper"); }),
              AllOf(HasSubstr((home_.data() / "paper.png").string() + " is another picture"),
                    HasSubstr("expected " + sha256_of_file(home_.paper())),
                    HasSubstr(sha256_of_file(home_.data() / "paper.png")), HasSubstr("rename or remove it"),
                    HasSubstr("take it from the archive")));
  EXPECT_THROW(exemplar_sha256(all.look_up("paper")), std::invalid_argument);
  EXPECT_THROW(load_exemplar(all.look_up("paper")), std::invalid_argument);
}

TEST_F(ExemplarsTest, AWrongFileIsToldEvenWhereTheRightOneIsInstalled) {
  ExemplarHome::write_picture(home_.data() / "grass.png", 7);
  EXPECT_THAT(message_of([&] { catalog().find("grass"); }), HasSubstr("is another picture"));
}

TEST_F(ExemplarsTest, AnotherVersionOfAPackageIsNotTakenEither) {
  std::filesystem::remove(home_.grass());
  ExemplarHome::write_picture(home_.grass(), 9);
  const ExemplarCatalog all = catalog();
  EXPECT_TRUE(all.look_up("grass").file.empty());
  EXPECT_THAT(message_of([&] { all.find("grass"); }),
              AllOf(HasSubstr("is another picture"), HasSubstr("apt-get install meadow-data")));
}

TEST_F(ExemplarsTest, AFileThatChangedSinceIsRefusedWhenItIsLoaded) {
  const ExemplarCatalog all = catalog();
  ExemplarHome::write_picture(home_.grass(), 9);
  EXPECT_THAT(message_of([&] { load_exemplar(all.find("grass")); }), HasSubstr("is another picture"));
}

TEST_F(ExemplarsTest, EveryOtherPictureOfTheUsersFolderIsAnExemplar) {
  ExemplarHome::write_picture(home_.data() / "my lawn.PNG", 3);
  ExemplarHome::write_picture(home_.data() / "float.exr", 3);
  std::ofstream(home_.data() / "notes.txt") << "not a picture";
  std::filesystem::create_directories(home_.data() / "folder.png");
  const ExemplarCatalog all = catalog();
  const ExemplarInfo& lawn = all.find("my lawn");
  EXPECT_EQ(lawn.source, "TEXTONBENCH_DATA");
  EXPECT_EQ(lawn.licence, "not stated");
  EXPECT_THAT(lawn.tags, IsEmpty());
  EXPECT_EQ(exemplar_sha256(lawn), sha256_of_file(home_.data() / "my lawn.PNG"));
  EXPECT_EQ(load_exemplar(all.find("float")).pixels.channels(), 3);
  EXPECT_THROW(all.find("notes"), std::invalid_argument);
  EXPECT_THROW(all.find("folder"), std::invalid_argument);
  EXPECT_EQ(all.all().size(), 11U);
}

TEST_F(ExemplarsTest, FilesThatAreNotPicturesFailWhenTheyAreLoaded) {
  std::ofstream(home_.data() / "empty.png").flush();
  std::ofstream(home_.data() / "text.jpg") << "no picture";
  const ExemplarCatalog all = catalog();
  EXPECT_THAT(message_of([&] { load_exemplar(all.find("empty")); }), HasSubstr("empty.png"));
  EXPECT_THAT(message_of([&] { load_exemplar(all.find("text")); }), HasSubstr("text.jpg"));
}

TEST_F(ExemplarsTest, TwoFilesMayNotHaveOneName) {
  ExemplarHome::write_picture(home_.data() / "lawn.png", 3);
  ExemplarHome::write_picture(home_.data() / "lawn.exr", 3);
  EXPECT_THAT(message_of([&] { catalog().find("lawn"); }), HasSubstr("would have the same name: rename one"));
}

TEST_F(ExemplarsTest, AFileMayNotTakeTheNameOfAProceduralExemplar) {
  ExemplarHome::write_picture(home_.data() / "ring.png", 3);
  EXPECT_THAT(message_of([&] { catalog().find("ring"); }), HasSubstr("ring.png has the name of a procedural exemplar"));
}

TEST_F(ExemplarsTest, ABadDataFolderIsNamed) {
  const DataVariable none(home_.path() / "nowhere");
  EXPECT_THAT(
      message_of([&] { catalog(); }),
      AllOf(HasSubstr("TEXTONBENCH_DATA=" + (home_.path() / "nowhere").string()), HasSubstr("expected a folder")));
  const DataVariable file(home_.paper());
  EXPECT_THAT(message_of([&] { catalog(); }), HasSubstr("expected a folder"));
}

TEST_F(ExemplarsTest, ProceduralExemplarsHaveDistinctHashesAndNoFile) {
  const ExemplarCatalog all = catalog();
  std::set<std::string> hashes;
  for (const ProceduralExemplar& exemplar : procedural_exemplars()) {
    const ExemplarInfo& info = all.find(exemplar.name);
    EXPECT_TRUE(info.file.empty());
    EXPECT_THAT(info.source, HasSubstr("procedural, seed 1"));
    hashes.insert(exemplar_sha256(info));
    const Exemplar loaded = load_exemplar(info);
    EXPECT_EQ(loaded.sha256, exemplar_sha256(info));
    EXPECT_EQ(loaded.pixels.extent(), procedural_extent);
    EXPECT_NO_THROW(require_usable(loaded));
  }
  EXPECT_EQ(hashes.size(), 5U);
}

TEST_F(ExemplarsTest, ABadCatalogFileIsToldWithItsPlace) {
  const std::string package = "[[package]]\nname = \"p\"\nsource = \"s\"\nlicence = \"l\"\nhow_to_get = \"h\"\n";
  const auto message = [&](const std::string& text) {
    home_.write_catalog(text);
    const std::string what = message_of([&] { catalog(); });
    const std::string file = home_.catalog().string() + ":";
    EXPECT_EQ(what.substr(0, file.size()), file);
    return what.substr(std::min(what.size(), file.size()));
  };
  EXPECT_THAT(message("[[package"), testing::StartsWith("1:"));
  EXPECT_THAT(message("[[package]]\nname = 3\n"), HasSubstr("2:8: name: expected a string"));
  EXPECT_THAT(message(package + "url = \"\"\n"), HasSubstr("6:1: unknown key \"url\" in [[package]]"));
  EXPECT_THAT(message(package + package), HasSubstr("7:8: a second [[package]] has that name"));
  EXPECT_THAT(message(package), HasSubstr("lacks the key \"exemplar\""));
  EXPECT_THAT(message(package + "[[exemplar]]\nname = \"e\"\npackage = \"q\"\n"), HasSubstr("8:11: unknown package"));
  const std::string exemplar = "[[exemplar]]\nname = \"e\"\npackage = \"p\"\n";
  EXPECT_THAT(message(package + exemplar + "sha256 = \"12\"\n"), HasSubstr("9:10: sha256: expected 64"));
  EXPECT_THAT(message(package + exemplar + "tag = \"x\"\n"), HasSubstr("did you mean \"tags\""));
  EXPECT_THAT(message(package + exemplar + exemplar), HasSubstr("9:1: a second [[exemplar]] is named \"e\""));
  EXPECT_THAT(message(package + "folder = \"/f\"\n" + exemplar), HasSubstr("lacks the key \"file\""));
}

/// The catalog that is delivered.
TEST(ExemplarCatalogTest, NamesTheDefaultsAndThePapersExemplars) {
  const DataVariable none("");
  const ExemplarCatalog all(TEXTONBENCH_SOURCE_DIR);
  EXPECT_THAT(all.tagged("default"), ElementsAre("mamurk_a_1", "mamurk_a_2", "mamurk_b_1", "mamurk_c_3", "mamurk_e_1",
                                                 "mamurk_e_2", "mamurk_f_1", "HR_DecoPaper", "HR_Cork", "white_noise",
                                                 "ring", "oriented_lobe", "power_law"));
  EXPECT_THAT(all.tagged("structured"), testing::IsSupersetOf({"HR_DecoPaper", "HR_Cork", "etr_pave01"}));
  EXPECT_EQ(all.tagged("paper").size(), 18U);
  for (const ExemplarInfo& info : all.all()) {
    EXPECT_FALSE(info.source.empty());
    EXPECT_FALSE(info.licence.empty());
    const bool procedural = info.source.starts_with("procedural");
    EXPECT_EQ(info.expected_sha256.size(), procedural ? 0U : 64U) << info.name;
    EXPECT_EQ(info.how_to_get.empty(), procedural) << info.name;
  }
  EXPECT_THAT(message_of([&] { all.find("0000_2"); }),
              AllOf(HasSubstr("not available here"), HasSubstr("compute_texton/input_textures"),
                    HasSubstr("Pandinosaurus/TextonNoise"), HasSubstr("TEXTONBENCH_DATA")));
}

TEST(ExemplarCatalogTest, ReadsThePapersExemplars) {
  const char* folder = std::getenv("TEXTONBENCH_DATA");
  if (folder == nullptr) GTEST_SKIP() << "set TEXTONBENCH_DATA to the folder of the papers' exemplars";
  const ExemplarCatalog all(TEXTONBENCH_SOURCE_DIR);
  for (const std::string& name : all.tagged("paper")) {
    const ExemplarInfo& info = all.look_up(name);
    if (!info.available) {
      EXPECT_TRUE(info.file.empty()) << info.how_to_get;
      continue;
    }
    EXPECT_EQ(load_exemplar(info).sha256, info.expected_sha256);
  }
}

}  // namespace textonbench::exemplars_test
