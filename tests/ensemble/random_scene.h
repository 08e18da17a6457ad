// A random tiny scene: containers, programmes, models, effects, species, sizes, precision, slots, friction
// laws.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/names.h"

namespace mcdem {

class RandomScene {
public:
    explicit RandomScene(unsigned seed) : engine_(seed) {}

    /// As TOML. Replicas differ in model, some also in grains or an effect.
    std::string text() {
        draw_container();
        draw_packing();
        draw_materials();
        draw_effects();
        draw_protocol();
        text_ += fmt::format(
            "[numerics]\nslots = {}\nprecision = \"{}\"\nskin = {}\nprobe_gap = {}\ntime_step = {}\n",
            chance(0.6) ? 16 : 32, chance(0.5) ? "float" : "double", between(0.05, 0.4), between(0.1, 0.4),
            between(0.03, 0.15));
        draw_variations();
        if (chance(0.4)) draw_species();
        return text_;
    }

private:
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }
    int whole(int low, int high) {
        return low + static_cast<int>(engine_() % static_cast<unsigned>(high - low + 1));
    }
    bool chance(double part) { return between(0, 1) < part; }
    double of_any_size(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }

    void draw_container() {
        const double drawn = between(0, 1);
        shape_ = drawn < 0.4   ? ContainerShape::box
                 : drawn < 0.6 ? ContainerShape::cylinder
                 : drawn < 0.8 ? ContainerShape::periodic
                               : ContainerShape::cell;
        const bool repeats = shape_ == ContainerShape::periodic || is_cell();
        count_ = static_cast<int>(of_any_size(is_cell() ? 80 : repeats ? 30 : 1, 120));
        mean_ = of_any_size(1e-3, 0.05);
    }

    bool is_cell() const { return shape_ == ContainerShape::cell; }

    /// Grains that fill a cell. The cell must be wider than a grain with its neighbours.
    void draw_cell(double widest, double fraction) {
        const double grains = count_ * std::numbers::pi / 6 * mean_ * mean_ * mean_;
        const double width = std::cbrt(grains / fraction) * between(0.97, 1.03);
        text_ += fmt::format("[container]\nshape = \"cell\"\nsize_x = {0}\nsize_y = {0}\n", width);
        draw_sizes(widest, fraction);
    }

    void draw_sizes(double widest, double fraction) {
        text_ += fmt::format(
            "[packing]\ndiameter_mean = {}\ndiameter_sd = {}\ndiameter_min = {}\ndiameter_max = "
            "{}\n"
            "packing_fraction = {}\nseed = {}\n",
            mean_, chance(0.3) ? 0 : 0.06 * mean_, 0.8 * mean_, widest, fraction, whole(0, 1000));
    }

    void draw_packing() {
        const double widest = 1.2 * mean_;
        if (is_cell()) return draw_cell(widest, between(0.5, 0.6));
        double height = between(1.6, 4) * widest, fraction = between(0.2, 0.6);
        const double floor = shape_ == ContainerShape::cylinder ? std::numbers::pi / 4 : 1;  // over width^2
        const double grains = count_ * std::numbers::pi / 6 * mean_ * mean_ * mean_;
        const double narrowest = shape_ == ContainerShape::periodic   ? 3.4 * widest
                                 : shape_ == ContainerShape::cylinder ? 2.2 * widest
                                                                      : 1.1 * widest;
        double width = 0;
        while ((width = std::sqrt(grains / (fraction * height * floor))) < narrowest) {
            height = std::max(1.6 * widest, 0.8 * height);
            fraction *= 0.8;
        }
        start_ = 1.05 * height;
        end_ = start_ - between(0.1, 0.4) * mean_;
        text_ += fmt::format("[container]\nshape = \"{}\"\n", name(shape_));
        text_ += shape_ == ContainerShape::cylinder ? fmt::format("radius = {}\n", width / 2)
                                                    : fmt::format("size_x = {0}\nsize_y = {0}\n", width);
        text_ +=
            fmt::format("[plate]\nstart = {}\nend = {}\nspeed = {}\n", start_, end_, between(2, 10) * mean_);
        draw_sizes(widest, fraction);
    }

    void draw_protocol() {
        text_ += fmt::format(
            "[protocol]\nstop_at_scans = {}\nrate_tolerance = 0\nrelax_time = 0.01\nsettle_time = 0.01\n",
            chance(0.7));
        if (is_cell())
            draw_cell_programme();
        else if (chance(0.3))
            draw_plate_programme();
        else
            text_ += fmt::format("scans_per_stroke = {}\n", whole(1, 3));
    }

    /// Down and part of the way back, to strains or to a force that may not be reachable; then a hold.
    void draw_plate_programme() {
        const double most = 1 - end_ / start_;
        const auto move = [&](double share) {
            text_ += fmt::format("[[programme]]\nstrain = {}\nscans = {}\n", share * most, whole(1, 2));
        };
        const auto hold = [&](const char* kept) {
            text_ += fmt::format("[[programme]]\nstage = \"hold\"\nkeep = \"{}\"\ntime = {}\nscans = {}\n",
                                 kept, between(0.001, 0.004), whole(1, 2));
        };
        move(between(0.3, 0.95));
        if (chance(0.6)) hold("position");
        if (chance(0.4)) {
            text_ += fmt::format("[[programme]]\nforce = {}\n", of_any_size(1e-3, 1));
            hold("force");
        }
        if (chance(0.5)) move(between(0, 0.3));
        if (chance(0.2)) text_ += "[[programme]]\nstage = \"repeat\"\nstages = 1\n";
    }

    /// Compression, shear, hold.
    void draw_cell_programme() {
        text_ += fmt::format("[[programme]]\nstrain = {}\nrate = {}\nscans = {}\n", between(0.005, 0.04),
                             between(1, 5), whole(1, 2));
        const char* const strains[]{"strain_x", "strain_z", "shear_xy", "shear_xz", "shear_yz"};
        for (const char* strain : strains)
            if (chance(0.3))
                text_ += fmt::format("[[programme]]\n{} = {}\nrate = {}\n", strain, between(-0.02, 0.05),
                                     between(1, 5));
        if (chance(0.5))
            text_ +=
                fmt::format("[[programme]]\nstage = \"hold\"\ntime = {}\nscans = 2\n", between(0.001, 0.01));
    }

    void draw_materials() {
        text_ += fmt::format(
            "[grains]\nyoungs_modulus = {}\npoisson_ratio = {}\ndensity = {}\nfriction = {}\n"
            "restitution = {}\ndrag = {}\n",
            of_any_size(5e3, 1e5), between(0, 0.5), of_any_size(5, 50), between(0, 0.6), between(0.2, 1),
            chance(0.5) ? 0 : between(0, 20));
        if (!is_cell()) text_ += fmt::format("excess_density = {}\n", chance(0.2) ? -2 : between(0, 10));
        if (!is_cell())
            text_ += fmt::format(
                "[walls]\nyoungs_modulus = {}\npoisson_ratio = {}\nfriction = {}\nrestitution = {}\n",
                of_any_size(1e5, 1e8), between(0, 0.5), between(0, 0.6), between(0.2, 1));
        text_ += fmt::format("[contact]\ngamma = {}\nfriction_law = \"{}\"\n", between(0.5, 1.3),
                             chance(0.5)   ? "mindlin"
                             : chance(0.5) ? "mindlin_displacement"
                                           : "saturated");
    }

    void draw_species() {
        const int species = whole(1, std::min(3, count_));
        for (int s = 1; s <= species; ++s) {
            text_ += fmt::format("[[species]]\nname = \"s{}\"\n", s);
            const auto maybe = [&](const char* key, double value) {
                if (chance(0.5)) text_ += fmt::format("{} = {}\n", key, value);
            };
            maybe("youngs_modulus", of_any_size(5e3, 1e5));
            maybe("poisson_ratio", between(0, 0.5));
            maybe("density", of_any_size(5, 50));
            maybe("friction", between(0, 0.6));
            maybe("restitution", between(0.2, 1));
        }
        if (species > 1 && chance(0.5))
            text_ += fmt::format("[[pair]]\nfirst = \"s1\"\nsecond = \"{}\"\nfriction = {}\n",
                                 is_cell() || chance(0.5) ? "s2" : "walls", between(0, 0.6));
    }

    void draw_effects() {
        text_ += "[effects]\n";
        const auto maybe = [&](const char* key, double amplitude) {
            if (chance(0.25)) text_ += fmt::format("{} = {}\n", key, amplitude);
        };
        maybe("adhesion", between(0, 0.02));
        maybe("cohesion", between(0, 500));
        maybe("net_force_friction", between(0, 1));
        maybe("viscoelasticity", between(0, 0.6));
        maybe("stiffening", between(-1, 1));
        maybe("law_exponent", between(-0.3, 0.5));
        maybe("finite_strain", between(0, 1));
        maybe("plasticity", between(0, 0.4));
        maybe("bulge_contacts", between(0, 1));
        maybe("friction_history", between(0, 1));
        maybe("rolling_resistance", between(0, 0.3));
        maybe("modulus_scatter", between(0, 0.4));
        maybe("diameter_error", between(-0.02, 0.02) * mean_);
        maybe("polydispersity", between(0, 0.03) * mean_);
        if (is_cell()) return;
        maybe("plate_compliance", between(0, 1e-3));
        if (shape_ == ContainerShape::periodic) return;
        maybe("plate_tilt_x", between(-0.05, 0.05));
        maybe("plate_tilt_y", between(-0.05, 0.05));
    }

    void draw_variations() {
        std::vector<ContactModel> models;
        for (const auto model :
             {ContactModel::independent, ContactModel::point_force_on_sphere, ContactModel::sphere_to_sphere,
              ContactModel::elastic_half_space, ContactModel::mc_dem, ContactModel::elastic_sphere,
              ContactModel::hyperelastic_sphere})
            models.push_back(model);
        std::shuffle(models.begin(), models.end(), engine_);
        text_ += fmt::format("[batch.vary]\n\"contact.model\" = [\"{}\", \"{}\"]\n", name(models[0]),
                             name(models[1]));
        const int fewer = chance(0.5) ? count_ : (4 * count_ + 4) / 5;
        text_ += fmt::format("\"packing.count\" = [{}{}]\n", count_,
                             fewer < count_ ? fmt::format(", {}", fewer) : "");
    }

    std::mt19937_64 engine_;
    std::string text_;
    ContainerShape shape_ = ContainerShape::box;
    int count_ = 0;
    double mean_ = 0;             ///< diameter [m]
    double start_ = 0, end_ = 0;  ///< of the plate [m]
};

}  // namespace mcdem
