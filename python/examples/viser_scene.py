"""A plan live in a browser (`pip install viser`), with a slider for time.

`python viser_scene.py --serve` keeps the scene until Ctrl-C; without, the plan is shown once and fast.
"""

import sys
import time

import numpy as np
import regrasp as rg

try:
    import viser
except ImportError:
    sys.exit("this example shows the plan with viser: pip install viser")

plan = rg.plan("cubic", seed=1)
hand = rg.Hand.built_in("four-finger")
centers = hand.fingertips(plan.joints)

server = viser.ViserServer("127.0.0.1", verbose=False)
size = plan.scenario["problem"]["object"]["shape"]["size"]
cube = server.scene.add_box("/object", dimensions=tuple(size), color=(230, 160, 60))
tips = [
    server.scene.add_icosphere(f"/{finger.name}", radius=hand.fingertip_radius, color=(70, 130, 200))
    for finger in hand.fingers
]
slider = server.gui.add_slider("time (s)", min=0.0, max=plan.duration, step=0.01, initial_value=0.0)


def show(seconds: float) -> None:
    """Puts everything where the plan has it at the last state not after this time."""
    row = int(np.searchsorted(plan.times, seconds, side="right")) - 1
    with server.atomic():
        cube.position, cube.wxyz = plan.positions[row], plan.orientations[row]
        for finger, tip in enumerate(tips):
            tip.position = centers[row, finger]


slider.on_update(lambda _: show(slider.value))
for seconds in plan.times:
    show(float(seconds))
print(f"{len(plan.times)} states shown at http://localhost:{server.get_port()}")
try:
    while "--serve" in sys.argv:
        time.sleep(0.2)
except KeyboardInterrupt:
    pass
server.stop()
