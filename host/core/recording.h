// Results of a run or an experiment as plain values, shared by simulator, files, metrics and figures.
// Measured and simulated data have the same form.
#pragma once
#include <fmt/format.h>

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/names.h"
#include "core/packing.h"
#include "core/parameters.h"

namespace mcdem::inline core {

/// One contact as seen from `grain`. A contact between two grains is listed once, with grain < partner.
struct Contact {
    int grain = 0;
    int partner = 0;            ///< a grain, or wall_partner(wall) < 0
    Vec3 point = Vec3::Zero();  ///< position of the contact [m]
    Vec3 force = Vec3::Zero();  ///< on `grain`, normal and tangential together [N]
    double overlap = 0;         ///< corrected overlap delta [m]; NaN if unknown (measured data)
};
constexpr int wall_partner(Wall wall) { return -1 - static_cast<int>(wall); }
constexpr bool is_wall(int partner) { return partner < 0; }
constexpr Wall wall_of(int partner) { return static_cast<Wall>(-1 - partner); }

/// All zeros; a default-constructed Vec3 is uninitialised.
inline std::array<Vec3, wall_count> no_wall_forces() {
    std::array<Vec3, wall_count> forces;
    forces.fill(Vec3::Zero());
    return forces;
}

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
inline Mat3 unknown_tensor() { return Mat3::Constant(unknown); }

/// The packing at one plate position. Averages that were not measured are NaN. Vectors are empty if positions
/// or contacts were not recorded.
struct Scan {
    int frame = 0;  ///< counts the scans of one recording from 0
    int cycle = 0;  ///< compression cycle, from 0
    Phase phase = Phase::load;
    double time = 0;     ///< [s]
    double plate_z = 0;  ///< height of the plate; for a cell, of the cell [m]
    Strain strain{};     ///< of a cell; zero otherwise
    std::array<Vec3, wall_count> wall_force =
        no_wall_forces();       ///< on each wall by the grains, or through each face of a cell [N]
    double kinetic_energy = 0;  ///< [J]
    double elastic_energy = 0;  ///< of contacts, surfaces and springs [J]
    /// Energy budget since the first steps [J]; NaN in measured data. Work done on the grains and losses are
    /// positive.
    double wall_work = unknown;      ///< by the plate, or by the motion of a cell
    double weight_work = unknown;    ///< by the weight
    double damping_loss = unknown;   ///< by normal damping of contacts
    double friction_loss = unknown;  ///< by friction and rolling resistance, with their damping
    double drag_loss = unknown;      ///< by drag of the fluid, and of stops for scans
    double energy_error = unknown;  ///< change of stored energy, plus losses, minus work: created by the time
                                    ///< step if positive; lost by viscoelasticity or plasticity if negative
    bool settled = false;           ///< the settling criterion was met
    double rate_error = unknown;  ///< estimated relative error of the mean force over packings, caused by the
                                  ///< plate's speed
    double coordination_number = 0;  ///< Z: contacts per grain, including walls, above the scene's threshold
    double mean_force = 0;           ///< <f>: mean |force| of those contacts [N]
    double packing_fraction = 0;     ///< phi, in the space more than a mean diameter from every wall
    double branch_length = 0;        ///< <b>: mean distance between centres of touching grains [m]
    double max_overlap = unknown;    ///< largest relative geometric overlap of two grains
                                     ///< (core/law_range.h); 0: no contact
    Mat3 stress = unknown_tensor();  ///< of the packing, compression positive (core/stress.h) [Pa]
    Mat3 fabric = unknown_tensor();  ///< mean of n n over contacts between grains
    std::vector<Vec3> position;      ///< by grain [m]
    std::vector<Vec3> rotation;  ///< since the start: axis times angle, at most pi [rad]; empty if unknown
    std::vector<Contact> contacts;

    /// False if the scan has contacts but none is listed, because they were not recorded or not read.
    bool knows_contacts() const { return !contacts.empty() || !(coordination_number > 0); }
    /// Upward force on the plate [N].
    double top_force() const { return wall_force[static_cast<int>(Wall::plate)].z(); }
};

/// Reason why a replica stopped before the end of its protocol.
struct Failure {
    long step = 0;
    int grain = -1;  ///< the user's grain number; -1 if no grain is the cause
    std::string cause;

    /// "step 200, grain 3: the reason"
    std::string text() const {
        return fmt::format("step {}{}: {}", step, grain < 0 ? "" : fmt::format(", grain {}", grain), cause);
    }
};

/// Results of one packing: a replica of a run, or an experiment.
struct Recording {
    std::string label;      ///< distinguishes it within its run, e.g. "mc_dem, packing 3"
    Parameters parameters;  ///< every scene key with its value for this replica
    Box box;
    double plate_start = 0;        ///< plate position at displacement zero [m]
    std::vector<double> diameter;  ///< [m]
    std::vector<int> species;      ///< of each grain, an index into species_names; empty without species
    std::vector<std::string> species_names;
    std::vector<Scan> scans;
    std::optional<Failure> failure;

    double displacement(const Scan& scan) const { return plate_start - scan.plate_z; }
};

/// A complete run: its provenance and its recordings.
struct Run {
    std::string name;
    std::string scene;      ///< text of the scene, with overrides
    std::string program;    ///< version and commit
    std::string device;     ///< device and driver
    std::string precision;  ///< float or double
    std::vector<Recording> recordings;
};

}  // namespace mcdem::core
