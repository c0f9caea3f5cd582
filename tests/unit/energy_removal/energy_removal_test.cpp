#include "tests/unit/energy_removal/milling_rig.h"
#include <cstdio>
#include <cstdlib>
#include <cstring>
using namespace bonemill; using namespace bonemill::test;
int main(int argc, char** argv) {
    RigConfig c; double force=3, seconds=0.3, feedspeed=0; bool trace=false; std::string axis="side";
    for (int i=1;i+1<argc;i+=2) { std::string k=argv[i]; double v=atof(argv[i+1]);
      if(k=="h") c.spacing.setConstant(v*1e-3); if(k=="rate") c.rate=v; if(k=="F") force=v; if(k=="t") seconds=v; if(k=="feed") feedspeed=v*1e-3;
      if(k=="R") c.burr.radius=v*1e-3; if(k=="krpm") c.burr.speed=v*kKrpm; if(k=="axis") axis=argv[i+1]; if(k=="trace") trace=v>0; if(k=="iso") c.iso=Density(v); if(k=="ramp") c.ramp=v; if(k=="factor") c.shell_factor=int(v); if(k=="u") c.removal.specific_energy=v*1e9; }
    if(axis=="side") c.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(M_PI/2, Eigen::Vector3d::UnitX()));
    if(axis=="pole") c.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(M_PI/2, Eigen::Vector3d::UnitX()));
    if(axis=="side") c.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(M_PI/2, Eigen::Vector3d::UnitZ()));
    if(axis=="oblique") c.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(M_PI/4, Eigen::Vector3d(1,0.3,0).normalized()));
    MillingRig rig(c);
    Eigen::Vector3d start(2.03e-3,1.98e-3,c.surface+c.burr.radius-1e-6);
    if (feedspeed>0) rig.feed(seconds,start,{0,0,-feedspeed}); else rig.press(seconds,start,-Eigen::Vector3d::UnitZ(),force);
    double vol=rig.removedVolume();
    std::printf("h %.4f rate %g: depth %.4f mm removed %.5f mm3 work %.6g removedE %.6g uV %.6g  work/uV-1 %.4f%% remE/work-1 %.4f%% faults %x\n", c.spacing[0]*1e3,c.rate, (start-rig.position()).z()*1e3, vol*1e9, rig.work(), rig.removedEnergy(), vol*c.removal.specific_energy, 100*(rig.work()/(vol*c.removal.specific_energy)-1), 100*(rig.removedEnergy()/rig.work()-1), rig.faults());
    if(trace) for (size_t n=0;n<rig.records.size();++n) { auto&r=rig.records[n]; std::printf("T %g %.6f %.5f %.5f %.5f %.5f %.6f %u %x %u %u\n", r.t_s*1e3, (start.z()-r.p_WT[2])*1e3, double(r.effects.burr_force), r.f_hand_W[2], double(r.effects.removal_power), double(r.effects.removed_energy)*c.rate, r.max_penetration*1e6, r.contacts, r.faults, r.iterations, r.candidates); }
}
