// Files are read again by HDF5 itself.
#include "haptic_server/recording/export/h5_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "common/base/user_error.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/recording/export/h5_reader.h"

namespace bonemill {
namespace {

class H5FileTest : public testing::Test {
  protected:
    test::TemporaryFolder folder_;
    std::string path_ = folder_ / "a.h5";
};

TEST_F(H5FileTest, HoldsWhatWasAppendedInBlocks) {
    {
        H5File file(path_);
        file.describe("scene", "slab \u00b5");
        file.describe("rate_hz", 1000);
        H5File::Column& force =
            file.addColumn("/tick/force_n", 3, H5File::Number::kDouble, {"N", "on the hand"});
        H5File::Column& faults = file.addColumn("/tick/faults", 1, H5File::Number::kUint32, {"bits", "bits"});
        for (int block = 0; block < 3; ++block) {
            std::vector<double> forces;
            std::vector<uint32_t> bits;
            for (int n = 0; n < 5000; ++n) {
                for (int axis = 0; axis < 3; ++axis) forces.push_back(block * 1e6 + n * 3 + axis);
                bits.push_back(0xffff0000u + uint32_t(n));
            }
            force.append(forces);
            faults.append(bits);
        }
        force.append(std::vector<double>{});
        file.writeTexts("/events/text", {"one", "", "zw\u00f6lf"}, "words");
        file.writeTexts("/none/text", {}, "nothing");
        file.close();
    }
    const test::H5Reader file(path_);
    const auto force = file.reals("/tick/force_n");
    EXPECT_EQ(force.shape, (std::vector<size_t>{15000, 3}));
    EXPECT_EQ(force.values[3 * 5000 + 4], 1e6 + 4);
    EXPECT_EQ(file.reals("/tick/faults").shape, std::vector<size_t>{15000});
    EXPECT_EQ(file.reals("/tick/faults").values[14999], 0xffff0000u + 4999.0);
    EXPECT_EQ(file.text("/tick/force_n", "unit"), "N");
    EXPECT_EQ(file.text("/tick/force_n", "description"), "on the hand");
    EXPECT_EQ(file.text("/", "scene"), "slab \u00b5");
    EXPECT_EQ(file.texts("/events/text"), (std::vector<std::string>{"one", "", "zw\u00f6lf"}));
}

TEST_F(H5FileTest, SaysThatItCannotBeWritten) {
    EXPECT_THROW(H5File(folder_ / "no/such.h5"), UserError);
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{100'000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    std::string message;
    try {
        H5File file(path_);
        H5File::Column& column = file.addColumn("/x", 1, H5File::Number::kDouble, {"1", "noise"});
        std::vector<double> noise(100'000);
        uint64_t seed = 1;
        for (double& value : noise) value = double(seed = seed * 6364136223846793005u + 1442695040888963407u);
        column.append(noise);
        file.close();
    } catch (const UserError& error) {
        message = error.what();
    }
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_NE(message.find("disk full"), std::string::npos) << message;
}

}  // namespace
}  // namespace bonemill
