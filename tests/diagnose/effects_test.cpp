// The table of effects: each effect changes its own parameter and nothing else.
#include "diagnose/effects.h"

#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <set>

#include "scene/read/keys.h"

namespace mcdem {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAreArray;

/// Every number of a model that an effect may change; those of keys, and of the instrument.
std::map<std::string, double> numbers_of(const Model& m) {
    const Instrument& i = m.instrument;
    std::map<std::string, double> all{{"contact.model", static_cast<double>(m.replica.contact.model)},
                                      {"friction_law", static_cast<double>(m.replica.contact.friction_law)},
                                      {"position_error", i.stated.position_error},
                                      {"stated force_threshold", i.stated.force_threshold},
                                      {"force_bias", i.force_bias},
                                      {"threshold_shift", i.threshold_shift},
                                      {"position_bias", i.position_bias},
                                      {"strain_offset", i.strain_offset},
                                      {"gauge_drift", i.gauge_drift},
                                      {"zero_drift", i.zero_drift},
                                      {"gauge_hysteresis", i.gauge_hysteresis},
                                      {"force_lag", i.force_lag},
                                      {"guide_friction", i.guide_friction},
                                      {"force_saturation", i.force_saturation},
                                      {"mean_diameter", m.mean_diameter}};
    Settings settings;
    settings.replica = m.replica;
    for (const Key& key : keys())
        if (const Parameter value = value_of(key, settings); std::holds_alternative<double>(value))
            all[std::string(key.name)] = std::get<double>(value);
    return all;
}

std::set<std::string> moved(const Model& before, const Model& after) {
    std::set<std::string> names;
    for (const auto& [name, value] : numbers_of(before))
        if (numbers_of(after).at(name) != value) names.insert(name);
    return names;
}

/// The parameter that each effect changes.
const std::map<std::string, std::set<std::string>> moves{
    {"cross_contact", {"contact.model", "contact.gamma"}},
    {"bulge_contacts", {"effects.bulge_contacts"}},
    {"friction", {"grains.friction"}},
    {"wall_friction", {"walls.friction"}},
    {"friction_history", {"effects.friction_history"}},
    {"adhesion", {"effects.adhesion"}},
    {"adhesion_net_friction", {"effects.adhesion", "effects.net_force_friction"}},
    {"cohesion", {"effects.cohesion"}},
    {"viscoelasticity", {"effects.viscoelasticity"}},
    {"stiffening", {"effects.stiffening"}},
    {"finite_strain", {"effects.finite_strain"}},
    {"plasticity", {"effects.plasticity"}},
    {"buoyancy", {"grains.excess_density"}},
    {"diameter_error", {"effects.diameter_error"}},
    {"polydispersity", {"effects.polydispersity"}},
    {"modulus_scatter", {"effects.modulus_scatter"}},
    {"rolling_resistance", {"effects.rolling_resistance"}},
    {"plate_tilt", {"effects.plate_tilt_x"}},
    {"plate_tilt_y", {"effects.plate_tilt_y"}},
    {"plate_compliance", {"effects.plate_compliance"}},
    {"force_bias", {"force_bias"}},
    {"gauge_drift", {"gauge_drift"}},
    {"zero_drift", {"zero_drift"}},
    {"gauge_hysteresis", {"gauge_hysteresis"}},
    {"force_lag", {"force_lag"}},
    {"guide_friction", {"guide_friction"}},
    {"force_saturation", {"force_saturation"}},
    {"force_threshold", {"threshold_shift"}},
    {"position_bias", {"position_bias"}},
    {"plate_speed", {"plate.speed"}},
    {"inertia", {"grains.density"}},
    {"time_step", {"numerics.time_step"}}};

Model plain_model() {
    Model model;
    model.replica.contact.model = ContactModel::independent;
    model.replica.contact.gamma = 1.125;
    model.replica.protocol.rate_tolerance = 0;
    model.instrument.stated.force_threshold = 4e-3;
    model.mean_diameter = 0.0215;
    return model;
}

/// A model in which no effect is zero.
Model full_model() {
    Model model = plain_model();
    model.replica.contact.model = ContactModel::mc_dem;
    model.replica.effects = {.adhesion = 0.01,
                             .cohesion = 50,
                             .net_force_friction = 0.4,
                             .viscoelasticity = 0.2,
                             .relaxation_time = 0.1,
                             .stiffening = 0.5,
                             .finite_strain = 0.3,
                             .plasticity = 0.1,
                             .bulge_contacts = 0.6,
                             .friction_history = 0.3,
                             .rolling_resistance = 0.1,
                             .modulus_scatter = 0.2,
                             .diameter_error = 1e-4,
                             .polydispersity = 2e-4,
                             .plate_tilt_x = 0.01,
                             .plate_tilt_y = -0.01,
                             .plate_compliance = 1e-4};
    model.instrument.force_bias = 0.05;
    model.instrument.gauge_drift = 0.02;
    model.instrument.zero_drift = 0.01;
    model.instrument.gauge_hysteresis = 0.02;
    model.instrument.force_lag = 1e-4;
    model.instrument.guide_friction = 0.01;
    model.instrument.force_saturation = 0.5;
    model.instrument.threshold_shift = 1e-3;
    model.instrument.position_bias = 1e-3;
    return model;
}

/// The names in the table of host/diagnose/README.md, in order.
std::vector<std::string> names_of_readme() {
    std::ifstream in(MCDEM_SOURCE_DIR "/host/diagnose/README.md");
    std::vector<std::string> names;
    std::string line;
    while (std::getline(in, line) && line != "## The effects") continue;
    while (std::getline(in, line)) {
        if (!line.starts_with("| `")) continue;
        const std::string cell = line.substr(0, line.find('|', 1));
        for (std::size_t from = cell.find('`'); from != std::string::npos;) {
            const std::size_t to = cell.find('`', from + 1);
            names.push_back(cell.substr(from + 1, to - from - 1));
            from = cell.find('`', to + 1);
        }
    }
    return names;
}

TEST(Effects, AgreeWithTheDocumentation) {
    std::vector<std::string> names;
    for (const Effect& effect : effects()) names.emplace_back(effect.name);
    std::vector<std::string> documented;
    for (const auto& [name, fields] : moves) documented.push_back(name);
    EXPECT_THAT(names, UnorderedElementsAreArray(documented));
    EXPECT_EQ(names, names_of_readme());
    for (const std::string& name : names) EXPECT_EQ(find_effect(name)->name, name);
    EXPECT_EQ(find_effect("phlogiston"), nullptr);
}

TEST(Effects, AmplitudesLieWithinTheirBounds) {
    for (const Effect& e : effects()) {
        SCOPED_TRACE(e.name);
        EXPECT_LE(e.low, 0);
        EXPECT_GT(e.high, 0);
        for (const double amplitude : {e.first, e.second}) {
            EXPECT_GE(amplitude, e.low);
            EXPECT_LE(amplitude, e.high);
            EXPECT_NE(amplitude, 0);
        }
        EXPECT_NE(e.first, e.second);
        EXPECT_GT(e.scale(plain_model()), 0);
        EXPECT_FALSE(e.formula.empty());
        EXPECT_FALSE(e.source.empty());
    }
}

TEST(Effects, ChangeOnlyTheirOwnParameter) {
    for (const Effect& e : effects())
        for (const double amplitude : {e.first, e.second}) {
            Model model = plain_model();
            e.apply(model, amplitude * e.scale(model));
            EXPECT_EQ(moved(plain_model(), model), moves.at(std::string(e.name))) << e.name;
        }
}

TEST(Effects, OfAmplitudeZeroChangeNothing) {
    for (const Effect& e : effects())
        for (const Model& start : {plain_model(), full_model()}) {
            if (!e.hindrance(start).empty()) continue;
            Model model = start;
            e.apply(model, 0);
            // Eq. 1 with gamma = 0 means independent contacts.
            if (e.name == "cross_contact")
                EXPECT_EQ(model.replica.contact.gamma, 0);
            else
                EXPECT_EQ(moved(start, model), std::set<std::string>{}) << e.name;
        }
}

TEST(Effects, AddToTheModelsAmplitude) {
    for (const Effect& e : effects()) {
        const Model start = full_model();
        if (!e.hindrance(start).empty()) continue;
        Model model = start;
        e.apply(model, e.second * e.scale(model));
        ASSERT_EQ(moved(start, model), moves.at(std::string(e.name))) << e.name;
        const std::string field = *moves.at(std::string(e.name)).begin();
        const double before = numbers_of(start).at(field), after = numbers_of(model).at(field);
        // The amplitudes of paired runs are positive in the end; only bulge_contacts and numerics decrease.
        if (field == "effects.bulge_contacts" || is_numerical(e.name))
            EXPECT_LT(after, before);
        else
            EXPECT_GT(after, before) << e.name;
    }
}

TEST(Effects, FractionsStayBetweenZeroAndOne) {
    for (const char* name : {"viscoelasticity", "friction_history", "bulge_contacts"}) {
        Model model = full_model();
        find_effect(name)->apply(model, find_effect(name)->high);
        const double after = numbers_of(model).at("effects." + std::string(name));
        EXPECT_GE(after, 0) << name;
        EXPECT_LE(after, 1) << name;
    }
}

TEST(Effects, OfNumericsNameTheirKey) {
    for (const Effect& e : effects()) {
        EXPECT_EQ(is_numerical(e.name), e.settings != nullptr) << e.name;
        if (!e.settings) continue;
        Model model = plain_model();
        const NumericalSetting setting = e.settings(model).front();
        const double before = numbers_of(model).at(std::string(setting.key));
        EXPECT_EQ(*setting.value, before) << e.name;
        e.apply(model, 0.5);
        EXPECT_NEAR(*setting.value, 0.5 * before, 1e-12 * before) << e.name;
        e.apply(model, 1);
        EXPECT_GT(*setting.value, 0) << "a run that ends";
    }
    EXPECT_FALSE(is_numerical("modulus"));
}

TEST(Effects, FrictionIsNeverNegative) {
    for (const char* name : {"friction", "wall_friction"}) {
        Model model = plain_model();
        find_effect(name)->apply(model, -1);
        EXPECT_EQ(
            numbers_of(model).at(name == std::string("friction") ? "grains.friction" : "walls.friction"), 0);
    }
}

TEST(Effects, ReasonsForExclusionAreGiven) {
    const Model independent = plain_model();
    Model interacting = independent, smooth = independent, unlimited = independent;
    interacting.replica.contact.model = ContactModel::elastic_sphere;
    smooth.replica.grains.friction = 0;
    unlimited.instrument.stated.force_threshold = 0;
    const auto hindered = [](const Model& model) {
        std::vector<std::string> names;
        for (const Effect& effect : effects())
            if (!effect.hindrance(model).empty()) names.emplace_back(effect.name);
        return names;
    };
    EXPECT_THAT(hindered(independent), ElementsAre("bulge_contacts", "finite_strain"));
    EXPECT_THAT(hindered(interacting), ElementsAre("cross_contact"));
    EXPECT_THAT(hindered(smooth),
                ElementsAre("bulge_contacts", "friction_history", "adhesion_net_friction", "finite_strain"));
    EXPECT_THAT(hindered(unlimited), ElementsAre("bulge_contacts", "finite_strain", "force_threshold"));
    Model stated = independent;
    stated.experiment_speed = 0.9 * stated.replica.plate.speed;
    EXPECT_THAT(hindered(stated), ElementsAre("bulge_contacts", "finite_strain"));
    stated.experiment_speed = stated.replica.plate.speed;
    EXPECT_THAT(hindered(stated), ElementsAre("bulge_contacts", "finite_strain", "plate_speed"));
    Model slow = independent;
    slow.replica.protocol.rate_tolerance = 0.01;
    EXPECT_THAT(hindered(slow), ElementsAre("bulge_contacts", "finite_strain", "plate_speed", "inertia"));
    Model adhesive = independent;
    adhesive.replica.effects.adhesion = 0.01;
    EXPECT_THAT(hindered(adhesive), ElementsAre("bulge_contacts", "adhesion_net_friction", "finite_strain"));
    slow.replica.protocol.rate_tolerance = 0.02;
    EXPECT_THAT(hindered(slow), ElementsAre("bulge_contacts", "finite_strain"));
}

// With a rate tolerance the plate's speed is reduced through the tolerance; plate.speed, its maximum, is
// reduced too.
TEST(Effects, PlateSpeedIsReducedThroughTheRateTolerance) {
    const Effect& effect = *find_effect("plate_speed");
    Model model = plain_model();
    model.replica.plate.speed = 0.1;
    EXPECT_EQ(effect.settings(model).front().key, "plate.speed");
    model.replica.protocol.rate_tolerance = 0.04;
    const auto settings = effect.settings(model);
    EXPECT_EQ(settings.front().key, "protocol.rate_tolerance");
    EXPECT_EQ(*settings.front().value, 0.04);
    effect.apply(model, 0.5);
    EXPECT_DOUBLE_EQ(model.replica.protocol.rate_tolerance, 0.02);
    EXPECT_DOUBLE_EQ(model.replica.plate.speed, 0.05);
}

TEST(Nuisances, ChangeTheirParameter) {
    Model model = plain_model();
    Experiment experiment;
    auto list = nuisances(model, experiment);
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].name, "modulus");
    EXPECT_EQ(list[1].name, "strain_offset");
    model.replica.contact.model = ContactModel::mc_dem;
    experiment.uncertainty = {{"grains.youngs_modulus", 0.1 * model.replica.grains.youngs_modulus},
                              {"grains.friction", 0.01},
                              {"walls.friction", 0.02}};
    list = nuisances(model, experiment);
    const std::string names[] = {"modulus", "strain_offset", "gamma", "friction", "wall_friction"};
    const std::string fields[] = {"grains.youngs_modulus", "strain_offset", "contact.gamma",
                                  "grains.friction", "walls.friction"};
    ASSERT_EQ(list.size(), 5u);
    EXPECT_NEAR(list[0].sigma, 0.1, 1e-12);
    EXPECT_EQ(list[3].sigma, 0.01);
    EXPECT_EQ(list[4].sigma, 0.02);
    for (std::size_t k = 0; k < 5; ++k) {
        EXPECT_EQ(list[k].name, names[k]);
        Model changed = model;
        list[k].apply(changed, 0);
        EXPECT_EQ(moved(model, changed), std::set<std::string>{}) << names[k];
        list[k].apply(changed, list[k].sigma);
        EXPECT_EQ(moved(model, changed), std::set{fields[k]});
    }
}

}  // namespace
}  // namespace mcdem
