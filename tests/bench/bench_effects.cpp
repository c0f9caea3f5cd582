#include <cmath>
#include <cstdio>

#include "common/base/units.h"
#include "haptic_server/lab/describe/effect_cost.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "tests/bench/bench_commands.h"
#include "tests/bench/bench_output.h"
#include "tests/bench/half_block.h"
#include "tests/support/every_effect_scene.h"
#include "tests/support/temporary_folder.h"

namespace bonemill::bench {
namespace {

struct EffectsOptions {
    test::EveryEffectBlock block{
        .edge = 160, .voxel_mm = 0.125, .burr_radius_mm = 1.5, .protected_depth_mm = 3};
    int ticks = 4000, rounds = 9;
    std::string json;
};

SceneSetup simulationOf(const EffectsOptions& o, const char* law) {
    const test::TemporaryFolder folder;
    test::writeBlock(folder.path().string(), o.block);
    test::writeScene(folder / "scene.textproto", test::everyEffectScene(o.block, law));
    return setUpScene(loadScene(folder / "scene.textproto"));
}

nlohmann::json toJson(const TickTimes& us) {
    return {{"p50", us.p50}, {"p99", us.p99}, {"p999", us.p99_9}, {"max", us.max}};
}

void addRow(Table& table, const std::string& name, const TickTimes& us) {
    table.add({name, number(us.p50), number(us.p99), number(us.p99_9), number(us.max)});
}

std::string signedNumber(double value) {
    return (value < 0 ? "" : "+") + number(value, 3);
}

nlohmann::json print(const EffectCosts& costs, const std::string& title) {
    std::printf("\n%s (%zu ticks in contact, medians of the rounds)\n", title.c_str(), costs.ticks);
    Table whole({"whole tick, us", "p50", "p99", "p99.9", "max"});
    addRow(whole, "with all of them", costs.all);
    for (const EffectCost& cost : costs.effects) addRow(whole, "without " + cost.name, cost.without);
    addRow(whole, "without any", costs.none);
    whole.print();
    Table added({"adds, us", "p50", "p99", "ratio of p50 with and without"});
    nlohmann::json json{{"all_us", toJson(costs.all)},
                        {"none_us", toJson(costs.none)},
                        {"noise_p50_us", costs.noise_p50_us},
                        {"noise_p99_us", costs.noise_p99_us}};
    for (const EffectCost& cost : costs.effects) {
        const double ratio = costs.all.p50 / cost.without.p50;
        added.add({cost.name, signedNumber(cost.p50_us), signedNumber(cost.p99_us), number(ratio)});
        json["effects"][cost.name] = {{"without_us", toJson(cost.without)},
                                      {"adds_p50_us", cost.p50_us},
                                      {"adds_p99_us", cost.p99_us},
                                      {"p50_ratio", ratio}};
    }
    added.add({"all of them", signedNumber(costs.all.p50 - costs.none.p50),
               signedNumber(costs.all.p99 - costs.none.p99), number(costs.all.p50 / costs.none.p50)});
    added.print();
    std::printf("noise (two runs with all, largest of the rounds): p50 %.3g us, p99 %.3g us\n",
                costs.noise_p50_us, costs.noise_p99_us);
    return json;
}

EffectCosts costsOf(const EffectsOptions& o, const char* law) {
    SceneSetup simulation = simulationOf(o, law);
    const std::vector<DeviceInput> path =
        weave(simulation.bone->volume,
              {.burr_radius = o.block.burr_radius_mm * kMillimetre, .depth = 0.5e-3, .ticks = o.ticks});
    return measureEffectCosts(simulation.fixedTick(), *simulation.bone, path, o.rounds);
}

void measure(const EffectsOptions& o) {
    std::printf("block of %d^3 voxels of %g mm, ball of %g mm radius\n", o.block.edge, o.block.voxel_mm,
                o.block.burr_radius_mm);
    nlohmann::json json;
    for (const char* law : {test::kByTime, test::kByEnergy})
        json[law] = print(costsOf(o, law), std::string("every effect, ") + law);
    writeJson(o.json, json);
}

}  // namespace

void addEffectsCommand(CLI::App& app) {
    auto o = std::make_shared<EffectsOptions>();
    CLI::App* command =
        app.add_subcommand("effects", "what each effect adds to a tick that mills a flat block");
    command->add_option("--volume", o->block.edge, "voxels per edge")->check(CLI::Range(64, 512));
    command->add_option("--voxel-mm", o->block.voxel_mm)->check(CLI::Range(0.01, 10.0));
    command->add_option("--burr-radius-mm", o->block.burr_radius_mm)->check(CLI::Range(0.1, 20.0));
    command->add_option("--ticks", o->ticks)->check(CLI::Range(1000, 1'000'000));
    command->add_option("--rounds", o->rounds, "of all variants in turn")->check(CLI::Range(1, 999));
    addJsonOption(*command, o->json);
    command->callback([o] { measure(*o); });
}

}  // namespace bonemill::bench
