// Libraries are read back as they were written; files that are not valid libraries are refused.
#include "diagnose/infer/library.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "diagnose/synthetic_evidence.h"

namespace mcdem {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class LibraryFile : public ::testing::Test {
protected:
    LibraryFile() {
        auto pattern = (std::filesystem::temp_directory_path() / "mcdem-test-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
        SyntheticWorld world(2, 1);
        Evidence evidence = world.evidence(2, 3);
        world.add_effect(evidence, "adhesion", world.pattern(0.1));
        world.add_nuisance(evidence, "modulus", world.pattern(1.0 / 3), 1);
        library = evidence.library;
        library.effects[0].curvature = world.pattern(1e-17);
        library.effects[0].linear = world.noise();  // NaN beyond the first cells
        library.provenance = {{"program", "0.1"}, {"device", "\"any\""}};
        library.origin = {{"grains.friction", "0.03"}};
        library.grid.force.assign(library.grid.displacement.size(), 0.1);
        library.grid.force_width = 1.0 / 7;
        library.grid.holds = {{3, 4, 5, Controlled::force, Phase::unload, 0.01 / 3}};
        write_library(file(), library);
    }
    ~LibraryFile() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path file() const { return folder_ / "library.json"; }
    nlohmann::json content() const {
        std::ifstream in(file());
        return nlohmann::json::parse(in);
    }
    void replace(const std::string& text) const { std::ofstream(file()) << text; }
    void expect_refused(const std::string& why) const {
        EXPECT_THAT([&] { read_library(file()); }, ThrowsMessage<InputError>(HasSubstr(why)));
    }

    Library library;

private:
    std::filesystem::path folder_;
};

/// True if all bits are equal; any two NaN are equal.
void expect_same(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    ASSERT_EQ(a.rows(), b.rows());
    ASSERT_EQ(a.cols(), b.cols());
    for (Eigen::Index k = 0; k < a.size(); ++k)
        EXPECT_TRUE(a.data()[k] == b.data()[k] || (std::isnan(a.data()[k]) && std::isnan(b.data()[k]))) << k;
}

void expect_same(const std::vector<Signature>& a, const std::vector<Signature>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
        EXPECT_EQ(a[k].name, b[k].name);
        EXPECT_EQ(a[k].reach, b[k].reach);
        EXPECT_EQ(a[k].pairs(), b[k].pairs());
        expect_same(a[k].linear, b[k].linear);
        expect_same(a[k].curvature, b[k].curvature);
        expect_same(a[k].spread(), b[k].spread());
    }
}

TEST_F(LibraryFile, IsReadBackAsWritten) {
    const Library back = read_library(file());
    EXPECT_EQ(back.grid.displacement, library.grid.displacement);
    EXPECT_EQ(back.grid.width, library.grid.width);
    EXPECT_EQ(back.grid.stroke, library.grid.stroke);
    EXPECT_EQ(back.grid.force, library.grid.force);
    EXPECT_EQ(back.grid.force_width, library.grid.force_width);
    EXPECT_EQ(back.grid.holds, library.grid.holds);
    EXPECT_EQ(back.packing, library.packing);
    EXPECT_EQ(back.provenance, library.provenance);
    EXPECT_EQ(back.origin, library.origin);
    expect_same(back.baseline, library.baseline);
    expect_same(back.effects, library.effects);
    expect_same(back.nuisances, library.nuisances);
}

TEST_F(LibraryFile, MayHoldMembersThatFormerProgramsWrote) {
    auto json = content();
    json.erase("sha256");
    for (auto& effect : json["effects"]) effect["variance"] = effect["linear"];
    replace(json.dump());
    expect_same(read_library(file()).effects, library.effects);
}

TEST_F(LibraryFile, IsRefusedIfMissing) {
    std::filesystem::remove(file());
    expect_refused("there is no signature library");
}

TEST_F(LibraryFile, IsRefusedIfDamaged) {
    std::ifstream in(file());
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    replace(text.substr(0, text.size() / 2));
    expect_refused("not a signature library");
    replace("[]");
    expect_refused("not a signature library");
    auto json = content();
    json = nlohmann::json::parse(text);
    json.erase("baseline");
    replace(json.dump());
    expect_refused("not a signature library");
}

TEST_F(LibraryFile, IsRefusedIfOfAnotherVersion) {
    auto json = content();
    json["format"] = json["format"].get<int>() + 1;
    replace(json.dump());
    expect_refused("of another version");
}

TEST_F(LibraryFile, IsRefusedIfItsOriginWasChanged) {
    auto json = content();
    json["origin"]["grains.friction"] = "0.9";
    replace(json.dump());
    expect_refused("what it says of its origin was changed");
}

TEST_F(LibraryFile, IsRefusedIfItsNumbersWereChanged) {
    auto json = content();
    json["baseline"][0][0] = 7.5;
    replace(json.dump());
    expect_refused("it was changed since it was written");
}

TEST_F(LibraryFile, IsNotOverwritten) {
    const auto before = content();
    EXPECT_FALSE(write_library(file(), library));
    EXPECT_EQ(content(), before);
}

TEST_F(LibraryFile, IsRefusedIfItHasOtherObservables) {
    auto json = content();
    json["baseline"][2].erase(0);
    replace(json.dump());
    expect_refused("its rows are of unequal length");
    for (const std::size_t row : {0, 1}) json["baseline"][row].erase(0);
    for (std::size_t row = 3; row < json["baseline"].size(); ++row) json["baseline"][row].erase(0);
    replace(json.dump());
    expect_refused("it has other observables than this program");
}

TEST_F(LibraryFile, IsRefusedIfAHoldCannotBe) {
    auto json = content();
    json["holds"][0]["begin"] = 6;
    replace(json.dump());
    expect_refused("it has a hold that cannot be");
    json["holds"][0]["phase"] = "sideways";
    replace(json.dump());
    expect_refused("there is no \"sideways\"");
}

TEST_F(LibraryFile, IsRefusedIfASignatureHasAnotherLength) {
    for (const char* part : {"linear", "curvature"}) {
        replace(library_text(library));
        auto json = content();
        json["effects"][0][part].erase(0);
        replace(json.dump());
        expect_refused("signature adhesion is of another length");
    }
    replace(library_text(library));
    auto json = content();
    for (auto& row : json["effects"][0]["slopes"]) row.erase(0);
    replace(json.dump());
    expect_refused("it has other observables than this program");
}

TEST_F(LibraryFile, IsRefusedWithoutReplicates) {
    auto json = content();
    json["packing"] = nlohmann::json::array();
    replace(json.dump());
    expect_refused("not a signature library");
}

TEST(Scatter, IsThatOfOneReplicateWithinItsPacking) {
    Library library;
    library.packing = {0, 1, 0, 1, 1};
    library.baseline.resize(5, 1);
    library.baseline << 1, 10, 3, 20, 30;
    const Eigen::VectorXd apart = scatter(library).col(0);
    const double two = std::sqrt(2), three = std::sqrt(1.5);
    EXPECT_LT((apart - Eigen::Matrix<double, 5, 1>(-two, -10 * three, two, 0, 10 * three)).norm(), 1e-12);
}

TEST(Scatter, IsTheScatterOverPackingsIfReplicatesAreSingle) {
    Library library;
    library.packing = {0, 1, 2};
    library.baseline.resize(3, 1);
    library.baseline << 1, 2, 6;
    EXPECT_LT((scatter(library).col(0) - std::sqrt(1.5) * Eigen::Vector3d(-2, -1, 3)).norm(), 1e-12);
}

TEST(Scatter, HasTheVarianceOfOneReplicate) {
    SyntheticWorld world(2, 5);
    const Eigen::MatrixXd apart = scatter(world.evidence(500, 2).library);
    EXPECT_NEAR(apart.col(3).squaredNorm() / 1000, 1, 0.25);  // 500 degrees of freedom: 0.063
}

}  // namespace
}  // namespace mcdem
