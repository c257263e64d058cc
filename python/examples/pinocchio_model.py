"""A hand in pinocchio (`pip install pin`): its model puts the fingertips of a plan's states where Regrasp does."""

import numpy as np
import pinocchio
import regrasp as rg

plan = rg.plan("sphere", seed=1)
hand = rg.Hand.built_in("four-finger")
model = pinocchio.buildModelFromXML(hand.to_urdf())
data = model.createData()
# pinocchio has an order of joints of its own.
columns = [model.idx_qs[model.getJointId(name)] for name in hand.joint_names]
tips = [model.getFrameId(f"{finger.name}-tip") for finger in hand.fingers]

centers = np.empty((len(plan.times), len(tips), 3))
q = pinocchio.neutral(model)
for row, joints in enumerate(plan.joints):
    q[columns] = joints
    pinocchio.framesForwardKinematics(model, data, q)
    centers[row] = [data.oMf[tip].translation for tip in tips]

worst = float(np.abs(centers - hand.fingertips(plan.joints)).max())
print(f"{model.nq} joints, {len(plan.times)} states: fingertips at most {worst:.1e} m apart")
