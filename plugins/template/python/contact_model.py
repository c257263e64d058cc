"""A contact model: point contact with a friction coefficient that is trusted only in part."""

import dataclasses

import regrasp as rg


class ScaledFriction(rg.ContactModel):
    """Point contact with a part of the object's friction."""

    id = "contact-model/template"
    references = ("Coulomb, Théorie des machines simples, 1785",)
    fewest_contacts = 3

    @dataclasses.dataclass(frozen=True)
    class Settings:
        """Settings of the contact model."""

        factor: float = rg.setting(
            0.9, range=(0.1, 1.0), doc="The part of the friction coefficient that counts."
        )

    def cone(self, finger: int, contact: rg.Contact, mu: float) -> tuple[float, float]:
        """`|f_t| ≤ factor · μ · f_n`, and no torque about the normal."""
        return self.settings.factor * mu, 0.0
