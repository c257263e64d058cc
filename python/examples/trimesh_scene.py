"""A state of a plan as a scene of trimesh: the object where it is, a ball for each fingertip."""

import regrasp as rg
import trimesh

plan = rg.plan("cubic", seed=1)
size = plan.scenario["problem"]["object"]["shape"]["size"]
row = len(plan.times) // 2
scene = trimesh.Scene()
scene.add_geometry(trimesh.creation.box(size), transform=plan.object_poses[row], geom_name="object")
hand = rg.Hand.built_in("four-finger")
for finger, center in zip(hand.fingers, hand.fingertips(plan.joints[row]), strict=True):
    ball = trimesh.creation.icosphere(radius=hand.fingertip_radius)
    ball.apply_translation(center)
    scene.add_geometry(ball, geom_name=finger.name)
print(len(scene.geometry), "bodies within", scene.extents.round(3), "m")
