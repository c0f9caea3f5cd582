"""How the simulated hands of the shipped scenes open the bone: for deploy/hand_planner.py, which explains the words."""
import math

from hand_planner import Field, Plan

# The tool's +y, to the hand, lies along W's +x.
FROM_THE_SIDE = ("0.70710678", "0", "0", "-0.70710678")
# And along its +z.
FROM_ABOVE = ("0.70710678", "0.70710678", "0", "0")

# The otologic burrs of 6 mm go along the sinus, from the canal wall backwards and again, below the tegmen; the dental one
# along the row of teeth, from the tongue's side to the cheek's.
PLANS = {
    "temporal_bone": Plan(
        burr_mm=3.0,
        # 1 sigmoid sinus, 2 facial nerve, 3 dura, 4 semicircular canals, 5 ossicles.
        clearance_mm={1: 1.6, 2: 2.5, 3: 1.4, 4: 2.0, 5: 2.0},
        # At the surface, and where the antrum is open. Behind and in front it ends higher than in its middle: towards the
        # tip the field is as narrow as the process.
        fields=(Field(((3.4, 15.5), (3.4, 8.5)), ((-14.0, 3.0), (-6.0, 2.5)), 0.3, 14.0,
                      shortened=lambda share: 0.65 * (abs(2 * share - 0.7) / 1.3) ** 2),),
        solid_mm=0.42, hollow_mm=0.95, step_mm=1.5, stroke_mm_per_s=20.0, most_mm3_per_s=math.inf,
        phases=((3.0, "cortex"), (8.5, "air cells"), (99.0, "antrum")),
        rest_mm=18.0, free_mm=4.0, axes=(0, 1, 2), turn=FROM_THE_SIDE),
    "mastoid": Plan(
        burr_mm=3.0,
        # 1 sigmoid sinus, 2 facial nerve, 3 dura.
        clearance_mm={1: 1.6, 2: 2.5, 3: 1.4},
        fields=(Field(((143.7, 150.7), (144.5, 148.0)), ((31.0, 38.0), (32.5, 36.5)), 0.45, 7.0),),
        solid_mm=0.38, hollow_mm=0.95, step_mm=1.5, stroke_mm_per_s=20.0, most_mm3_per_s=11.5,
        phases=((4.0, "cortex"), (99.0, "air cells")),
        rest_mm=204.0, free_mm=198.0, axes=(0, 1, 2), turn=FROM_THE_SIDE),
    "third_molar": Plan(
        burr_mm=1.5,
        # 1 nerve, 2 to 4 third molar, 5 second molar, 6 lingual plate.
        clearance_mm={1: 1.5, 2: 0.25, 3: 0.25, 4: 0.25, 5: 0.9, 6: 0.4},
        # In front of the crown's top, behind it, and a gutter on the cheek's side.
        fields=(Field(((-2.3, 7.2), (-1.5, 7.2)), ((1.5, 6.9), (1.5, 6.9)), 0.45, 4.0),
                Field(((-2.3, 7.2), (-1.5, 7.2)), ((6.9, 11.8), (6.9, 11.8)), 0.45, 4.0),
                Field(((6.6, 7.4), (6.6, 7.4)), ((1.8, 11.5), (2.5, 11.5)), 3.6, 4.5)),
        solid_mm=0.4, hollow_mm=0.8, step_mm=0.9, stroke_mm_per_s=12.0, most_mm3_per_s=4.0,
        phases=((2.0, "cortex"), (99.0, "gutter")),
        rest_mm=22.0, free_mm=10.0, axes=(2, 0, 1), turn=FROM_ABOVE),
}
