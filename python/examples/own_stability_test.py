"""A stability test of one's own: its plan, and the laws that it keeps."""

# ANCHOR: plugin
import dataclasses

import numpy as np
import numpy.typing as npt
import regrasp as rg


class Cautious(rg.StabilityTest):
    """Force closure with friction to spare."""

    references = ("V.-D. Nguyen, Constructing force-closure grasps, IJRR 1988",)

    @dataclasses.dataclass(frozen=True)
    class Settings:
        """Settings of the test."""

        share: float = rg.setting(0.9, range=(0.1, 1.0), doc="The share of the friction that it relies on.")

    def test(self, grasp: rg.Grasp) -> bool:
        friction = self.settings.share * grasp.friction
        return bool(rg.force_closure(grasp.points, grasp.normals, friction))

    def margin(
        self, grasp: rg.Grasp, length: float | None, center: npt.NDArray[np.float64] | None
    ) -> tuple[float, float]:
        friction = self.settings.share * grasp.friction
        low, high = rg.closure_margin(grasp.points, grasp.normals, friction, center=center, length=length)
        return float(low), float(high)


# ANCHOR_END: plugin

if __name__ == "__main__":
    print(rg.plan("sphere", seed=1, use={"stability-test": Cautious}))
    print(rg.conformance.check(Cautious))
