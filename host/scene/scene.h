// A scene as plain values in SI units. Tests can build one without a file.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/names.h"
#include "core/packing.h"
#include "core/parameters.h"
#include "scene/packing/read_packing.h"
#include "scene/programme.h"
#include "scene/species.h"

namespace mcdem::inline scene {

struct WallMaterial {
    double youngs_modulus = 50e6;  ///< [Pa]
    double poisson_ratio = 0.5;
    double friction = 0.03;     ///< mu between grain and wall
    double restitution = 0.95;  ///< e
};

struct ContactLaw {
    ContactModel model = ContactModel::mc_dem;
    double gamma = 1.125;  ///< prefactor of Eq. 1, used by mc_dem only
    FrictionLaw friction_law = FrictionLaw::mindlin;
    double sliding_velocity = 1e-3;  ///< below it saturated friction decreases to zero [m/s]
};

/// Read from a LIGGGHTS/LAMMPS data file or dump, a Yade text file, a CSV (x_m,y_m,z_m,diameter_m) or a
/// run.h5.
struct PackingFile {
    std::string path;
    std::optional<long> step = std::nullopt;  ///< timestep or frame, see read_packing
    PackingReader reader = read_packing;
    FilePacking read() const { return reader(path, step); }
};

/// Random packing: truncated normal diameters, grown and relaxed without weight or friction.
struct GeneratedPacking {
    int count = 514;
    double diameter_mean = 21.490e-3;  ///< [m]
    double diameter_sd = 1.199e-3;     ///< [m]
    double diameter_min = 18.167e-3;   ///< [m]
    double diameter_max = 24.561e-3;   ///< [m]
    double packing_fraction = 0.59;    ///< determines the height of the packing in the box
};

struct PackingSource {
    std::variant<PackingFile, GeneratedPacking> source = GeneratedPacking{};
    double position_jitter = 0;  ///< standard deviation of a normal displacement of every coordinate [m]
    std::uint64_t seed = 1;      ///< for generation, jitter and assignment of species
    FractionsBy fractions_by = FractionsBy::number;
};

struct Plate {
    double start = 0.167643;  ///< highest position of its lower face [m]
    double end = 0.137517;    ///< lowest position [m]
    double speed = 0.1;       ///< maximum [m/s]
};

struct Protocol {
    int cycles = 1;
    int discard = 0;                        ///< number of first cycles that metrics ignore
    int scans_per_stroke = 30;              ///< equally spaced; the last of each stroke at its end
    bool stop_at_scans = false;             ///< the plate waits at each scan until the packing settles
    double rate_tolerance = 0.01;           ///< maximum estimated relative error of mean forces over packings
                                            ///< caused by the plate's speed; 0: always plate.speed
    double settle_unbalanced_force = 1e-3;  ///< a scan is taken when the net forces on grains fall below this
    double settle_time = 0.5;  ///< a scan is taken after this time at the latest, marked as unsettled [s]
    double settle_drag = 1e6;  ///< on velocities and spins while the plate stands still; removes at most half
                               ///< of both per step [1/s]
    double pause = 0;  ///< > 0: at each scan the plate stops smoothly and stands for this time instead [s]
    double hold = 0;   ///< > 0: after each stroke down the plate stands for this time [s]
    double relax_time = 1.0;     ///< maximum relaxation time before the first stroke [s]
    bool scan_at_start = false;  ///< record a scan (frame 0) of the relaxed packing before the first stroke
    double force_threshold = 0;  ///< contacts with smaller forces are ignored in Z and <f> [N]
};

struct Numerics {
    double time_step = 0.1;  ///< maximum, over the Rayleigh time of the smallest grain
    double skin = 0.2;       ///< margin of the neighbour list over the mean radius
    double probe_gap =
        0.15;  ///< maximum gap at which surface displacements can create contacts, over the mean radius
    double overlap_limit = 0.5;    ///< relative corrected overlap (core/law_range.h) beyond which the replica
                                   ///< stops; on walls over the radius
    bool stop_beyond_law = false;  ///< stop at the first scan beyond the range in core/law_range.h
};

/// Effects beyond the plain model. At its default each is off and costs nothing.
struct Effects {
    double adhesion = 0;            ///< work of adhesion w between grains [J/m2]
    double cohesion = 0;            ///< attraction over the area 2 pi R* overlap of a contact [J/m3]
    double net_force_friction = 0;  ///< fraction of both attractions that reduces the Coulomb limit
    double viscoelasticity = 0;     ///< fraction of the Hertz force that relaxes at constant overlap
    double relaxation_time = 0.1;   ///< relaxation time of that fraction [s]
    double stiffening =
        0;  ///< c: Hertz force times 1 + c overlap / R*; for c < 0 divided by 1 - c overlap / R*
    double law_exponent = 0;  ///< m: Hertz force times (overlap / (0.1 R*))^m
    double finite_strain =
        0;  ///< weight of the difference between hyperelastic_sphere and elastic_sphere; elastic_sphere only
    double plasticity = 0;  ///< fraction of the largest overlap that remains after unloading
    double bulge_contacts =
        1;  ///< fraction of the surface displacement that counts where undeformed grains do not overlap
    double friction_history =
        0;  ///< weight of saturated friction beside a spring, or of mindlin beside saturated
    double rolling_resistance = 0;  ///< mu_r: the rolling spring yields at mu_r R* F_n
    double modulus_scatter = 0;     ///< standard deviation of ln E between grains
    double diameter_error = 0;      ///< true minus stated diameter, the same for all grains [m]
    double polydispersity = 0;      ///< standard deviation of true minus stated diameter [m]
    double width_error_x = 0;       ///< true minus stated width of the container along x [m]
    double width_error_y = 0;       ///< the same along y
    double plate_tilt_x = 0;        ///< slope of the plate along x
    double plate_tilt_y = 0;        ///< the same along y
    double plate_compliance = 0;    ///< displacement of the plate per newton [m/N]
};

/// All inputs of one replica.
struct Replica {
    std::string label;      ///< distinguishes it within its run, e.g. "mc_dem #3"
    Parameters parameters;  ///< every scene key with its value for this replica
    Box box{0.165191, 0.165834};
    GrainMaterial grains;          ///< of all grains, or defaults of the species
    std::vector<Species> species;  ///< empty: one material
    std::vector<SpeciesPair> pairs;
    WallMaterial walls;
    ContactLaw contact;
    PackingSource packing;
    Plate plate;
    Protocol protocol;
    std::vector<Stage> programme;  ///< empty: the cycles of `protocol`
    Numerics numerics;
    Effects effects;
};

/// Fraction of the friction force from a Mindlin spring; the rest is saturated friction.
inline double mindlin_share(const Replica& replica) {
    const double other = replica.effects.friction_history;
    return replica.contact.friction_law == FrictionLaw::saturated ? other : 1 - other;
}

struct Output {
    bool positions = true;          ///< record positions at scans
    bool contacts = true;           ///< record contacts at scans
    double checkpoint_minutes = 1;  ///< wall-clock time between checkpoints
};

struct Scene {
    std::string name = "scene";
    std::string text;  ///< TOML with overrides, stored in result files
    Precision precision = Precision::single_precision;
    int slots = 16;  ///< neighbour slots per grain: 16, 32, 48 or 64
    Output output;
    std::vector<Replica> replicas;
};

}  // namespace mcdem::scene
