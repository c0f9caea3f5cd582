// An effect that is not listed takes no memory: every byte that operator new gives out is counted.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "haptic_server/core/effects/effect_host.h"
#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "tests/support/every_effect_scene.h"
#include "tests/support/temporary_folder.h"

// GCC 12 sees the aligned_alloc in operator new below, not that the operators belong together.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

namespace {

thread_local size_t given_bytes = 0;

void* give(size_t size, size_t alignment) {
    given_bytes += size;
    // The function aligned_alloc wants a multiple of the alignment.
    void* const memory = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    if (!memory) throw std::bad_alloc();
    return memory;
}

}  // namespace

void* operator new(size_t size) {
    return give(size, __STDCPP_DEFAULT_NEW_ALIGNMENT__);
}
void* operator new(size_t size, std::align_val_t alignment) {
    return give(size, size_t(alignment));
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, size_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, size_t, std::align_val_t) noexcept {
    std::free(memory);
}

namespace bonemill {
namespace {

template <class Action>
size_t bytesOf(Action&& action) {
    const size_t before = given_bytes;
    action();
    return given_bytes - before;
}

class EffectMemory : public testing::Test {
  protected:
    EffectMemory() : simulation_(makeScene()), all_(simulation_.tick.effects) {}

    SceneSetup makeScene() const {
        const test::EveryEffectBlock block;
        test::writeBlock(folder_.path().string(), block);
        test::writeScene(folder_ / "scene.textproto", test::everyEffectScene(block, test::kByEnergy));
        return setUpScene(loadScene(folder_ / "scene.textproto"));
    }
    EffectConfigs only(const std::string& which) const {
        EffectConfigs configs = all_;
        for (const std::string& name : effectNames(all_))
            if (name != which) configs = withoutEffect(std::move(configs), name);
        return configs;
    }
    // Counts the bytes of a whole tick with these effects.
    size_t bytesOfTick(const EffectConfigs& configs) {
        FixedTickConfig config = simulation_.fixedTick();
        config.effects = configs;
        return bytesOf([&] { FixedTick(config, *simulation_.bone); });
    }

    test::TemporaryFolder folder_;
    SceneSetup simulation_;
    EffectConfigs all_;
};

TEST_F(EffectMemory, NoneListedIsNotAByte) {
    const EffectConfigs none;
    const EffectRoom room{};
    EXPECT_EQ(bytesOf([&] {
                  EffectHost host(makeEffects(none, *simulation_.bone, room), 100'000, 1);
                  host.restart(Restart::kOtherTool);
                  host.begin({});
                  host.finish(true);
              }),
              0u);
}

TEST_F(EffectMemory, EachTakesItsOwnAndNothingWhenItIsNotListed) {
    const size_t without_any = bytesOfTick(only(""));
    const size_t with_all = bytesOfTick(all_);
    for (const std::string& name : effectNames(all_)) {
        EXPECT_GT(bytesOfTick(only(name)), without_any) << name;
        EXPECT_LT(bytesOfTick(withoutEffect(all_, name)), with_all) << name;
    }
}

}  // namespace
}  // namespace bonemill
