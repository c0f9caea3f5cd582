// CHAI3D's voxel object and finger proxy in the benchmark (docs/reference/benchmark.md has the protocol).
//
// It is written after the headers of CHAI3D 3.1.1, and has never been compiled or run by us: CHAI3D does not
// ship with bonemill, and no figure of it is claimed. To build it, with CHAI3D built in $CHAI3D:
//
//   g++ -std=c++17 -O2 -I$CHAI3D/src -I$CHAI3D/external/Eigen -I$CHAI3D/external/glew/include -DLINUX
//     chai3d_voxels.cpp -L$CHAI3D/lib/release/lin-x86_64-cc -lchai3d -lGLU -lGL -ldl -lpthread -o
//     chai3d_voxels
//
// The world is in mm, because the proxy's least distance from a surface is a ten-thousandth of its unit. A
// voxel is bone or none to it, a ball of half an edge; the proxy has three degrees of freedom, no drag and no
// torque. A voxel is removed when its middle lies in the proxy while the pedal is down.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "chai3d.h"

namespace {

using Json = nlohmann::json;

struct Volume {
    int size[3] = {};
    double edge = 0, origin[3] = {};  // mm
    std::string head;
    std::vector<std::uint16_t> values;

    size_t at(int x, int y, int z) const {
        return size_t(x) + size_t(size[0]) * (size_t(y) + size_t(size[1]) * size_t(z));
    }
};

Volume readVolume(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    Volume volume;
    for (std::string line; std::getline(file, line) && !line.empty();) {
        volume.head += line + "\n";
        const auto value = [&](const char* format, auto*... to) {
            return std::sscanf(line.c_str(), format, to...);
        };
        value("sizes: %d %d %d", &volume.size[0], &volume.size[1], &volume.size[2]);
        value("space directions: (%lf", &volume.edge);
        value("space origin: (%lf,%lf,%lf)", &volume.origin[0], &volume.origin[1], &volume.origin[2]);
    }
    volume.values.resize(size_t(volume.size[0]) * size_t(volume.size[1]) * size_t(volume.size[2]));
    file.read(reinterpret_cast<char*>(volume.values.data()), std::streamsize(2 * volume.values.size()));
    const bool is_raw = volume.head.find("type: uint16") != std::string::npos &&
                        volume.head.find("encoding: raw") != std::string::npos;
    if (!file || !is_raw) throw std::runtime_error("it reads volumes of raw uint16 only");
    return volume;
}

// CHAI3D's picture has a byte of opacity for each voxel: bone or none.
class Bone {
  public:
    Bone(const Volume& volume, int iso) : volume_(volume), iso_(iso), image_(chai3d::cMultiImage::create()) {
        const int* n = volume_.size;
        image_->allocate(n[0], n[1], n[2], GL_RGBA, GL_UNSIGNED_BYTE);
        for (int z = 0; z < n[2]; ++z)
            for (int y = 0; y < n[1]; ++y)
                for (int x = 0; x < n[0]; ++x) paint(x, y, z);
        auto texture = chai3d::cTexture3d::create();
        texture->setImage(image_);
        object_ = new chai3d::cVoxelObject();
        object_->setTexture(texture);
        object_->setIsosurfaceValue(0.5);
        object_->setHapticEnabled(true);
        const double half = volume_.edge / 2;
        for (int a = 0; a < 3; ++a) {
            object_->m_minCorner(a) = volume_.origin[a] - half;
            object_->m_maxCorner(a) = volume_.origin[a] - half + n[a] * volume_.edge;
        }
    }
    chai3d::cVoxelObject* object() { return object_; }
    const Volume& volume() const { return volume_; }

    int removeWithin(const chai3d::cVector3d& p, double radius) {
        int removed = 0, low[3], high[3];
        for (int a = 0; a < 3; ++a) {
            const double middle = (p(a) - volume_.origin[a]) / volume_.edge, reach = radius / volume_.edge;
            low[a] = std::max(0, int(std::ceil(middle - reach)));
            high[a] = std::min(volume_.size[a] - 1, int(std::floor(middle + reach)));
        }
        for (int z = low[2]; z <= high[2]; ++z)
            for (int y = low[1]; y <= high[1]; ++y)
                for (int x = low[0]; x <= high[0]; ++x) {
                    std::uint16_t& value = volume_.values[volume_.at(x, y, z)];
                    const chai3d::cVector3d q(volume_.origin[0] + x * volume_.edge,
                                              volume_.origin[1] + y * volume_.edge,
                                              volume_.origin[2] + z * volume_.edge);
                    if (value < iso_ || (q - p).length() >= radius) continue;
                    value = 0;
                    paint(x, y, z);
                    ++removed;
                }
        return removed;
    }

  private:
    void paint(int x, int y, int z) {
        const bool is_bone = volume_.values[volume_.at(x, y, z)] >= iso_;
        image_->setVoxelColor(x, y, z, chai3d::cColorb(255, 255, 255, is_bone ? 255 : 0));
    }

    Volume volume_;
    int iso_;
    chai3d::cMultiImagePtr image_;
    chai3d::cVoxelObject* object_ = nullptr;  // the world's, once it is a child
};

struct Row {
    double t = 0, p[3] = {}, q[4] = {};
    int buttons = 0;
};

bool readRow(std::istream& file, Row& row) {
    std::string line;
    if (!std::getline(file, line)) return false;
    return std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%d", &row.t, &row.p[0], &row.p[1],
                       &row.p[2], &row.q[0], &row.q[1], &row.q[2], &row.q[3], &row.buttons) == 9;
}

void answer(const std::string& folder, const std::string& out) {
    std::ifstream scene_file(folder + "/scene.json");
    const Json scene = Json::parse(scene_file);
    if (scene["tool"]["shape"] != "ball") throw std::runtime_error("it knows no tool but a ball");
    const double radius = scene["tool"]["radius_mm"];
    Bone bone(readVolume(folder + "/volume.nrrd"), scene["volume"]["iso_value"]);
    bone.object()->m_material->setStiffness(double(scene["contact"]["coupling_n_per_mm"]));
    chai3d::cWorld world;
    world.addChild(bone.object());
    world.computeGlobalPositions(true);
    chai3d::cAlgorithmFingerProxy proxy;
    proxy.setProxyRadius(radius);

    std::ifstream way(folder + "/trajectory.csv");
    std::ofstream told(out + "/answer.csv");
    told.precision(12);
    told << "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,fx_n,fy_n,fz_n,removed_voxels,tick_us\n";
    std::string head;
    std::getline(way, head);
    bool is_first = true;
    bool has_milled = false;
    for (Row row; readRow(way, row);) {
        const chai3d::cVector3d hand(1e3 * row.p[0], 1e3 * row.p[1], 1e3 * row.p[2]);
        if (is_first) proxy.initialize(&world, hand);
        is_first = false;
        const auto begin = std::chrono::steady_clock::now();
        const int removed = row.buttons & 1 ? bone.removeWithin(proxy.getProxyGlobalPosition(), radius) : 0;
        const chai3d::cVector3d force = proxy.computeForces(hand, chai3d::cVector3d(0, 0, 0));
        const std::chrono::duration<double, std::micro> tick = std::chrono::steady_clock::now() - begin;
        has_milled |= removed > 0;
        const chai3d::cVector3d tool = proxy.getProxyGlobalPosition();
        told << row.t << ',' << tool(0) / 1e3 << ',' << tool(1) / 1e3 << ',' << tool(2) / 1e3;
        for (const double q : row.q) told << ',' << q;
        told << ',' << force(0) << ',' << force(1) << ',' << force(2) << ',' << removed << ',' << tick.count()
             << '\n';
    }
    if (!has_milled) return;
    const Volume& after = bone.volume();
    std::ofstream file(out + "/volume_after.nrrd", std::ios::binary);
    file << after.head << "\n";
    file.write(reinterpret_cast<const char*>(after.values.data()), std::streamsize(2 * after.values.size()));
}

}  // namespace

int main(int count, char** words) {
    try {
        if (count == 2 && std::string(words[1]) == "--about")
            std::puts(
                R"({"name": "CHAI3D voxels", "version": "3.1.1", "can": ["mill"], "notes": "finger proxy"})");
        else if (count == 3)
            answer(words[1], words[2]);
        else
            throw std::runtime_error("chai3d_voxels --about | FOLDER OUT");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "chai3d_voxels: %s\n", error.what());
        return 1;
    }
}
