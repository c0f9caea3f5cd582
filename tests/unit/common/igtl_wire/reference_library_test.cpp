// Another implementation, OpenIGTLink's own library, reads what is sent here and writes what is taken here.
#include <gtest/gtest.h>
#include <igtlImageMessage.h>
#include <igtlNDArrayMessage.h>
#include <igtlPolyDataMessage.h>
#include <igtlStatusMessage.h>
#include <igtlStringMessage.h>
#include <igtlTransformMessage.h>

#include <cstring>
#include <numeric>

#include "common/igtl_wire/igtl_messages.h"
#include "tests/support/openigtlink_reader.h"

namespace bonemill::igtl {
namespace {

using test::readByLibrary;

std::vector<Frame> readHere(::igtl::MessageBase& message) {
    message.Pack();
    FrameReader reader({kWantedTransform, kWantedString});
    std::vector<Frame> frames;
    const std::string complaint =
        reader.take({static_cast<const char*>(message.GetPackPointer()), size_t(message.GetPackSize())},
                    [&](const Frame& frame) { frames.push_back(frame); });
    EXPECT_EQ(complaint, "");
    return frames;
}

Eigen::Isometry3d somewhere() {
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    place.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
    place.pretranslate(Eigen::Vector3d(-12.5, 340.25, 7.75));
    return place;
}

TEST(IgtlReference, ReadsATransform) {
    const auto message =
        readByLibrary<::igtl::TransformMessage>(transformFrame("tool", 1'500'000'000, somewhere()));
    ASSERT_TRUE(message.IsNotNull());
    EXPECT_STREQ(message->GetDeviceName(), "tool");
    unsigned seconds = 0, fraction = 0;
    message->GetTimeStamp(&seconds, &fraction);
    EXPECT_EQ(seconds, 1u);
    EXPECT_EQ(fraction, 1u << 31);
    ::igtl::Matrix4x4 matrix;
    message->GetMatrix(matrix);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            EXPECT_EQ(matrix[row][column], float(somewhere().matrix()(row, column)));
}

TEST(IgtlReference, WritesATransformThatIsReadHere) {
    auto message = ::igtl::TransformMessage::New();
    message->SetDeviceName("Tracker");
    ::igtl::Matrix4x4 matrix;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            matrix[row][column] = float(somewhere().matrix()(row, column));
    message->SetMatrix(matrix);
    const auto frames = readHere(*message);
    ASSERT_EQ(frames.size(), 1u);
    EXPECT_EQ(frames[0].device, "Tracker");
    EXPECT_TRUE(transformOf(frames[0].body)->isApprox(Eigen::Affine3d(somewhere()), 1e-6));
}

TEST(IgtlReference, WritesAStringThatIsReadHereAndTheOtherWayRound) {
    auto message = ::igtl::StringMessage::New();
    message->SetDeviceName("order");
    message->SetString("restore last");
    const auto frames = readHere(*message);
    ASSERT_EQ(frames.size(), 1u);
    EXPECT_EQ(stringOf(frames[0].body), "restore last");
    const auto back = readByLibrary<::igtl::StringMessage>(stringFrame("event", 0, "Fräse ruht"));
    ASSERT_TRUE(back.IsNotNull());
    EXPECT_STREQ(back->GetString(), "Fräse ruht");
    EXPECT_EQ(back->GetEncoding(), 106);
}

TEST(IgtlReference, ReadsAStatus) {
    const auto message =
        readByLibrary<::igtl::StatusMessage>(statusFrame("bonemill", 0, StatusCode::kNotReady, "no session"));
    ASSERT_TRUE(message.IsNotNull());
    EXPECT_EQ(message->GetCode(), ::igtl::StatusMessage::STATUS_NOT_READY);
    EXPECT_STREQ(message->GetStatusString(), "no session");
}

TEST(IgtlReference, ReadsAnArrayOfNumbers) {
    const std::vector<double> numbers{1.5, -2.25, 3, 0.001, -1e-6, 1e6};
    const auto message = readByLibrary<::igtl::NDArrayMessage>(numbersFrame("wrench", 0, numbers));
    ASSERT_TRUE(message.IsNotNull());
    EXPECT_EQ(message->GetType(), ::igtl::NDArrayMessage::TYPE_FLOAT64);
    ::igtl::ArrayBase* const array = message->GetArray();
    ASSERT_EQ(array->GetDimension(), 1);
    ASSERT_EQ(array->GetRawArraySize(), numbers.size() * sizeof(double));
    EXPECT_EQ(std::memcmp(array->GetRawArray(), numbers.data(), array->GetRawArraySize()), 0);
}

TEST(IgtlReference, ReadsASurface) {
    const Surface surface{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1.5f}},
                          {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                          {0, 2, 1, 0, 1, 3}};
    const auto message = readByLibrary<::igtl::PolyDataMessage>(surfaceFrame("bone", 0, surface));
    ASSERT_TRUE(message.IsNotNull());
    ASSERT_EQ(message->GetPoints()->GetNumberOfPoints(), 4);
    for (unsigned n = 0; n < 4; ++n) {
        float point[3];
        message->GetPoints()->GetPoint(n, point);
        EXPECT_EQ(Eigen::Vector3f(point), surface.points[n]);
    }
    ASSERT_EQ(message->GetPolygons()->GetNumberOfCells(), 2u);
    std::list<igtlUint32> cell;
    message->GetPolygons()->GetCell(1, cell);
    EXPECT_EQ(cell, (std::list<igtlUint32>{0, 1, 3}));
    ASSERT_EQ(message->GetNumberOfAttributes(), 1);
    ::igtl::PolyDataAttribute* const normals = message->GetAttribute(0u);
    EXPECT_EQ(normals->GetType(), ::igtl::PolyDataAttribute::POINT_NORMAL);
    EXPECT_STREQ(normals->GetName(), "normals");
    float normal[3];
    normals->GetNthData(1, normal);
    EXPECT_EQ(Eigen::Vector3f(normal), surface.normals[1]);
}

TEST(IgtlReference, ReadsASurfaceWithNothingInIt) {
    const auto message = readByLibrary<::igtl::PolyDataMessage>(surfaceFrame("bone", 0, {}));
    ASSERT_TRUE(message.IsNotNull());
    EXPECT_EQ(message->GetPoints()->GetNumberOfPoints(), 0);
}

TEST(IgtlReference, ReadsAnImageWithItsPlace) {
    ImagePlace place{{3, 4, 5}, Eigen::Matrix3d::Zero(), {10, -20, 30}};
    place.columns = somewhere().rotation() * Eigen::Vector3d(0.5, 0.75, 2).asDiagonal();
    std::vector<int16_t> voxels(60);
    std::iota(voxels.begin(), voxels.end(), int16_t(-30));
    const auto message = readByLibrary<::igtl::ImageMessage>(imageFrame("volume", 0, place, voxels));
    ASSERT_TRUE(message.IsNotNull());
    int size[3];
    message->GetDimensions(size);
    EXPECT_EQ(Eigen::Vector3i(size), place.voxels);
    float spacing[3];
    message->GetSpacing(spacing);
    EXPECT_TRUE(Eigen::Vector3f(spacing).isApprox(Eigen::Vector3f(0.5f, 0.75f, 2), 1e-5f));
    EXPECT_EQ(message->GetScalarType(), ::igtl::ImageMessage::TYPE_INT16);
    EXPECT_EQ(message->GetCoordinateSystem(), ::igtl::ImageMessage::COORDINATE_RAS);
    ASSERT_EQ(size_t(message->GetImageSize()), voxels.size() * 2);
    EXPECT_EQ(std::memcmp(message->GetScalarPointer(), voxels.data(), voxels.size() * 2), 0);
    // As 3D Slicer does it: the matrix has unit columns, and its place is the middle of the image.
    ::igtl::Matrix4x4 matrix;
    message->GetMatrix(matrix);
    Eigen::Matrix3f axes;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) axes(row, column) = matrix[row][column];
    const Eigen::Vector3f middle(matrix[0][3], matrix[1][3], matrix[2][3]);
    const Eigen::Vector3f half = (Eigen::Vector3f(2, 3, 4).array() * Eigen::Array3f(spacing) / 2).matrix();
    EXPECT_TRUE((middle - axes * half).isApprox(place.first.cast<float>(), 1e-5f));
}

}  // namespace
}  // namespace bonemill::igtl
