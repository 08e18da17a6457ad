// Random scenes: bit-identical alone, in a batch, in parts, and with any number of threads; forces on walls
// and grains are opposite; replicas that come to their end are lawful (lawful_run.h). MCDEM_RANDOM_SCENES is
// the number of scenes, MCDEM_RANDOM_SEED the first seed.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>

#include "core/container.h"
#include "core/sha256.h"
#include "core/stress.h"
#include "ensemble/lawful_run.h"
#include "ensemble/make_packings.h"
#include "ensemble/random_scene.h"
#include "ensemble/recording_bits.h"
#include "ensemble/small_scene.h"

namespace mcdem {
namespace {

int setting(const char* variable, int otherwise) {
    const char* text = std::getenv(variable);
    return text ? std::atoi(text) : otherwise;
}
int number_of_scenes() { return setting("MCDEM_RANDOM_SCENES", 12); }

/// All output of a replica as one text.
std::string told_of(const Recording& recording) {
    std::string told = bits_of(recording);
    if (recording.failure)
        told += fmt::format("{} {} {}", recording.failure->step, recording.failure->grain,
                            recording.failure->cause);
    return told;
}

/// Replicas from `first` to `last` (excluded), in a batch of their own.
std::vector<Recording> simulate_some(Device& device, const Scene& scene, const std::vector<Packing>& packings,
                                     std::size_t first, std::size_t last) {
    Scene some = scene;
    some.replicas.assign(scene.replicas.begin() + first, scene.replicas.begin() + last);
    return simulate(device, some, {packings.begin() + first, packings.begin() + last});
}

/// The wall forces equal the sums of the contact forces at the walls. (Not with adhesion, which acts across
/// gaps without contact.)
void expect_action_is_reaction(const Scan& scan, Precision precision) {
    auto from_contacts = no_wall_forces();
    double size = 0;
    for (const Contact& contact : scan.contacts)
        if (is_wall(contact.partner)) {
            from_contacts[static_cast<int>(wall_of(contact.partner))] -= contact.force;
            size += contact.force.norm();
        }
    const double allowed = (precision == Precision::double_precision ? 1e-12 : 1e-5) * size;
    for (int wall = 0; wall < wall_count; ++wall)
        EXPECT_LE((from_contacts[wall] - scan.wall_force[wall]).norm(), allowed) << "wall " << wall;
}

/// The stress of a cell equals that of its contacts; the forces through its faces are area times stress.
void expect_stress_of_contacts(const Recording& recording, const Scan& scan, Precision precision) {
    const Mat3 stress = packing_stress(recording.box, scan);
    double size = 0;
    for (const Contact& contact : scan.contacts) size += contact.force.norm();
    const Box now = deformed(recording.box, scan.strain);
    const double allowed = (precision == Precision::double_precision ? 1e-12 : 1e-5) * size * now.size_x /
                           (now.size_x * now.size_y * now.height);
    EXPECT_LE((stress - scan.stress).norm(), allowed);
    const auto forces = face_forces(now, scan.stress);
    for (int wall = 0; wall < wall_count; ++wall)
        EXPECT_LE((forces[wall] - scan.wall_force[wall]).norm(), 1e-6 * forces[wall].norm())
            << "face " << wall;
}

/// Output of all replicas of a complete simulation. `more`: also checks parts and single replicas.
std::string check(Device& device, unsigned seed, bool more) {
    const std::string text = RandomScene(seed).text();
    SCOPED_TRACE(fmt::format("seed {}:\n{}", seed, text));
    const Scene scene =
        parse_scene(text, "random.toml",
                    device.info().double_precision ? std::vector<std::string>{}
                                                   : std::vector<std::string>{"numerics.precision=float"});
    const auto packings = make_packings(scene);
    const std::size_t count = packings.size();
    const auto together = simulate_some(device, scene, packings, 0, count);
    std::string told;
    for (const Recording& recording : together) told += told_of(recording);
    if (!more) return told;
    auto parts = simulate_some(device, scene, packings, 0, count - 1);
    for (Recording& last : simulate_some(device, scene, packings, count - 1, count))
        parts.push_back(std::move(last));
    const auto alone = simulate_some(device, scene, packings, 0, 1);
    for (std::size_t r = 0; r < count; ++r) {
        EXPECT_TRUE(told_of(together[r]) == told_of(parts[r])) << "in parts: " << together[r].label;
        SCOPED_TRACE(together[r].label);
        expect_lawful(scene.replicas[r], packings[r], together[r], scene.precision);
        for (const Scan& scan : together[r].scans) {
            if (scene.replicas[r].effects.adhesion != 0) continue;
            if (is_cell(together[r].box))
                expect_stress_of_contacts(together[r], scan, scene.precision);
            else
                expect_action_is_reaction(scan, scene.precision);
        }
    }
    EXPECT_TRUE(told_of(together[0]) == told_of(alone[0])) << "alone: " << together[0].label;
    return told;
}

/// Hashes of the output of random scenes, from a separate process with this number of threads.
std::string hashes_on_threads(int threads, const std::filesystem::path& folder) {
    const auto file = folder / std::to_string(threads);
    const pid_t child = fork();
    if (child == 0) {
        setenv("POCL_MAX_PTHREAD_COUNT", std::to_string(threads).c_str(), 1);
        setenv("MCDEM_RANDOM_HASHES", file.c_str(), 1);
        execl("/proc/self/exe", "test_ensemble",
              "--gtest_filter=RandomScenes.AreTheSameAloneInABatchAndInParts", static_cast<char*>(nullptr));
        _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0) << threads << " threads";
    return bytes_of_file(file);
}

TEST(RandomScenes, AreTheSameAloneInABatchAndInParts) {
    Device device;
    const int first = setting("MCDEM_RANDOM_SEED", 1), count = number_of_scenes();
    const char* const hashes_wanted = std::getenv("MCDEM_RANDOM_HASHES");
    std::string hashes;
    for (int seed = first; seed < first + count && !HasFailure(); ++seed) {
        const std::string told = check(device, static_cast<unsigned>(seed), !hashes_wanted);
        hashes += fmt::format("{} {}\n", seed, Sha256().add(std::string_view(told)).hex());
    }
    if (hashes_wanted) std::ofstream(hashes_wanted) << hashes;
}

TEST(RandomScenes, AreTheSameOnAnyNumberOfThreads) {
    const TestFolder folder;
    const std::string one = hashes_on_threads(1, folder.path);
    EXPECT_EQ(std::count(one.begin(), one.end(), '\n'), number_of_scenes());
    EXPECT_EQ(hashes_on_threads(5, folder.path), one);
}

}  // namespace
}  // namespace mcdem
