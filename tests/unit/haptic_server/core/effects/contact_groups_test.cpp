#include "haptic_server/core/effects/surface_friction/contact_groups.h"

#include <gtest/gtest.h>

#include "tests/support/contact_set.h"

namespace bonemill {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Sums {
    double force = 0;
    Vector3d moment = Vector3d::Zero();
    Matrix3d tangential = Matrix3d::Zero();
};

struct ContactGroupsTest : testing::Test {
    void addOnPeg(int count, double radius, double half_length) {
        std::uniform_real_distribution<double> uniform(-1, 1);
        for (int n = 0; n < count; ++n) {
            const double angle = M_PI * uniform(random);
            const Vector3d out(std::cos(angle), 0, std::sin(angle));
            contacts.add(bench.tick.X_VT_start.rotation *
                             Vector3d(radius * out + half_length * uniform(random) * Vector3d::UnitY()),
                         bench.tick.X_VT_start.rotation * -out, 1.1 + uniform(random), 0, n % 2);
        }
    }
    Sums sumsOf(double burr_share) const {
        Sums sums;
        for (size_t n = 0; n < contacts.contacts.size(); ++n) {
            const double force = (contacts.on_burr[n] ? burr_share : 1) * double(contacts.contacts[n].force);
            const Vector3d normal = contacts.contacts[n].push_V.cast<double>();
            sums.force += force;
            sums.moment += force * contacts.contacts[n].r_V.cast<double>();
            sums.tangential += force * (Matrix3d::Identity() - normal * normal.transpose());
        }
        return sums;
    }

    std::mt19937 random{3};
    test::BurrTick bench;
    test::ContactSet contacts;
    ContactGroups groups;
};

TEST_F(ContactGroupsTest, KeepForceMomentAndWhatATranslationStretches) {
    bench.tick.X_VT_start.rotation = expRotation({0.5, 0.9, -0.4});
    addOnPeg(3000, 1e-3, 8e-3);
    contacts.giveTo(bench.tick);
    for (const double share : {0.0, 0.3, 1.0}) {
        groups.gather(bench.tick, share);
        EXPECT_LE(groups.groups().size(), ContactGroups::kMax);
        const Sums wanted = sumsOf(share);
        Sums sums;
        for (const ContactGroup& group : groups.groups()) {
            sums.force += group.force;
            sums.moment += group.force * group.r;
            sums.tangential += group.force * group.tangential;
        }
        EXPECT_NEAR(groups.force(), wanted.force, 1e-9 * wanted.force);
        EXPECT_NEAR(sums.force, wanted.force, 1e-9 * wanted.force);
        EXPECT_LT((sums.moment - wanted.moment).norm(), 1e-9 * wanted.force * 1e-3);
        EXPECT_LT((sums.tangential - wanted.tangential).norm(), 1e-9 * wanted.force);
    }
}

// Σ F |P (ω × r)|² of the groups is compared with the contacts'.
TEST_F(ContactGroupsTest, LoseLittleOfATurn) {
    addOnPeg(3000, 1e-3, 8e-3);
    contacts.giveTo(bench.tick);
    groups.gather(bench.tick, 1);
    for (const Vector3d& turn : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0.3, 0.2, -1)}) {
        double wanted = 0, got = 0;
        for (const SurfaceContact& contact : contacts.contacts) {
            const Vector3d moved = turn.cross(contact.r_V.cast<double>());
            const Vector3d normal = contact.push_V.cast<double>();
            wanted += double(contact.force) * (moved.squaredNorm() - std::pow(moved.dot(normal), 2));
        }
        for (const ContactGroup& group : groups.groups()) {
            const Vector3d moved = turn.cross(group.r);
            got += group.force * moved.dot(group.tangential * moved);
        }
        EXPECT_NEAR(got, wanted, 0.1 * wanted);
    }
}

TEST_F(ContactGroupsTest, AreNoneWithoutContacts) {
    addOnPeg(10, 1e-3, 8e-3);
    contacts.giveTo(bench.tick);
    groups.gather(bench.tick, 1);
    EXPECT_FALSE(groups.groups().empty());
    bench.tick.contacts = {};
    groups.gather(bench.tick, 1);
    EXPECT_TRUE(groups.groups().empty());
    EXPECT_EQ(groups.force(), 0);
}

TEST_F(ContactGroupsTest, OfOnePlaceAreOne) {
    for (int n = 0; n < 5; ++n) contacts.add({1e-3, 0, 0}, {-1, 0, 0}, 2);
    contacts.giveTo(bench.tick);
    groups.gather(bench.tick, 1);
    ASSERT_EQ(groups.groups().size(), 1u);
    EXPECT_NEAR(groups.groups()[0].force, 10, 1e-9);
}

}  // namespace
}  // namespace bonemill
