"""A state of a plan as a scene of trimesh: the object where it is, a ball for each fingertip."""

import regrasp as rg
import trimesh

plan = rg.plan("cubic", seed=1)
size = plan.scenario["problem"]["object"]["shape"]["size"]
row = len(plan.times) // 2
scene = trimesh.Scene()
scene.add_geometry(trimesh.creation.box(size), transform=plan.object_poses[row], geom_name="object")
hand = rg.Hand.built_in("four-finger")
for finger, known in enumerate(hand.fingers):
    joints = plan.joints[row, 3 * finger : 3 * finger + 3]
    ball = trimesh.creation.icosphere(radius=hand.fingertip_radius)
    ball.apply_translation(hand.fk(finger, joints))
    scene.add_geometry(ball, geom_name=known.name)
print(len(scene.geometry), "bodies within", scene.extents.round(3), "m")
