//! The stability of single grasps, by the plugins of a run.

use super::{NeverStops, RunError, Setup};
use regrasp_api::{Configuration, Context, Grasp, GraspContact, Random, Vec3};

impl Setup<'_> {
    /// The margin that the stability test gives the grasp of all fingers that touch at `q`, at rest and with the friction that planning
    /// relies on: a certified lower bound, in the test's own unit, 0 or less where the grasp is not stable.
    ///
    /// Torques are taken about the object's centre of mass and divided by its size, so that margins compare.
    pub fn margin(&self, q: &Configuration) -> Result<f64, RunError> {
        let problem = &self.scenario.problem;
        let object = &self.scenario.object;
        let mu = object.friction * problem.limits.resolution.friction_margin;
        let mut grasp = Grasp::new(q.X_HO.rotation.inverse() * Vec3::from(problem.gravity));
        for (finger, contact) in q.contacts.iter() {
            if let Some(contact) = contact {
                let cone = self.plugins.contact_model.cone(contact, mu);
                grasp.push(GraspContact { finger, p_OC: contact.p_OC, n_O: contact.n_O, cone });
            }
        }
        let frame = regrasp_plan::MarginFrame::of_object(object);
        let mut context = Context::new(Random::from_key(0, 0, 0, 0), &NeverStops);
        let (length, center_O) = (Some(frame.length), Some(Vec3::from(frame.center_O)));
        let assessed = self.plugins.stability.assess(&grasp, length, center_O, &mut context);
        assessed.map(|assessment| assessment.margin_lower).map_err(RunError::Call)
    }
}
