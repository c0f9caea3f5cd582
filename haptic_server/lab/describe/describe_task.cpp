#include "haptic_server/lab/describe/describe_task.h"

#include "common/base/units.h"
#include "haptic_server/assessment/product/zone_tally.h"

namespace bonemill {
namespace {

void describeRules(const JudgedTask& task, std::ostream& out) {
    for (const GateRule& gate : task.gates)
        out << "  gate: " << gate.figure_id << (gate.is_most ? " at most " : " at least ") << gate.limit
            << '\n';
    for (const ScoreRule& score : task.scores)
        out << "  sub-score: " << score.figure_id << " from 0 at " << score.worst << " to 1 at " << score.best
            << ", weight " << score.weight << '\n';
    if (!task.scores.empty())
        out << "  weights of version " << task.weights_version << ", hash " << task.weights_hash << '\n';
}

}  // namespace

void describeTask(const Simulation& simulation, std::ostream& out) {
    if (!simulation.task) return;
    const JudgedTask& task = *simulation.task;
    const VoxelVolume& volume = simulation.bone->volume;
    const ProductCounts counts = countProduct(volume, volume, task);
    const double voxel_mm3 = volume.voxelVolume() * kPerCubicMillimetre;
    out << "task: feedback " << scene::Task::Feedback_Name(scene::Task::Feedback(task.feedback))
        << (task.is_exam ? ", an examination" : "");
    if (task.time_limit_s > 0) out << ", " << task.time_limit_s << " s";
    if (task.most_attempts > 0) out << ", " << task.most_attempts << " attempts at most";
    out << "\n  ideal" << (task.reference ? " (hidden reference): " : ": ")
        << double(counts.ideal) * voxel_mm3 << " mm3 of bone shall be gone\n";
    for (size_t n = 0; n < task.zones.size(); ++n)
        out << "  zone '" << task.zones[n].name << "', "
            << scene::Task::Role_Name(scene::Task::Role(task.zones[n].role)) << ": "
            << double(counts.zones[n + 1].bone) * voxel_mm3 << " mm3 of bone\n";
    for (const Structure& structure : task.structures) out << "  protected: '" << structure.name << "'\n";
    describeRules(task, out);
}

}  // namespace bonemill
