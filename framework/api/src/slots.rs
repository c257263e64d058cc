//! The roles and the slots that plugins fill: one row each, from which everything else about them is derived.

use serde::{Deserialize, Serialize};

/// Hands the table of the roles to the macro `$then`: `[variant, name in code, trait] (id, what it answers)`.
#[macro_export]
macro_rules! with_roles {
    ($then:ident) => {
        $then! {
            [ContactModel contact_model ContactModel]
                ("contact-model", "Which wrenches a contact can transmit.")
            [StabilityTest stability_test StabilityTest]
                ("stability-test", "Whether a grasp is stable.")
            [Surface surface SurfaceParam]
                ("surface", "The object's surface.")
            [Sampler sampler ClosedChainSampler]
                ("sampler", "Random closed chains.")
            [LocalPlanner local_planner LocalPlanner]
                ("local-planner", "Connecting two configurations.")
            [GraphStrategy graph_strategy GraphStrategy]
                ("graph-strategy", "What to do next.")
        }
    };
}

/// Hands the table of the slots to the macro `$then`: `[variant, field, trait] (role, id, plugin by default,
/// what it is for)`.
///
/// The defaults are what the paper names in section IV, "Planning algorithm": rolling transfers, the random
/// loop generator, RRT for regrasps, the biased α. `surface` alone is not: the paper's is `steiner`.
#[macro_export]
macro_rules! with_slots {
    ($then:ident) => {
        $then! {
            [ContactModel contact_model ContactModel]
                (ContactModel, "contact-model", "contact-model/pcwf", "Which wrenches contacts transmit.")
            [StabilityTest stability StabilityTest]
                (StabilityTest, "stability-test", "stability-test/force-closure", "Which grasps are stable.")
            [Surface surface SurfaceParam]
                (Surface, "surface", "surface/geodesic", "The object's surface.")
            [Sampler sampler ClosedChainSampler]
                (Sampler, "sampler", "sampler/rlg", "Samples closed chains.")
            [GraspPlanner grasp LocalPlanner]
                (LocalPlanner, "local-planner.grasp", "local-planner/linear", "Connects inside GS_n.")
            [TransferPlanner transfer LocalPlanner]
                (LocalPlanner, "local-planner.transfer", "local-planner/rolling", "Rolls the object.")
            [RegraspPlanner regrasp LocalPlanner]
                (LocalPlanner, "local-planner.regrasp", "local-planner/rrt", "Moves one finger.")
            [GraphStrategy strategy GraphStrategy]
                (GraphStrategy, "graph-strategy", "graph-strategy/interleaved", "Decides what to do next.")
        }
    };
}

macro_rules! roles {
    ($([$role:ident $name:ident $trait:ident] ($id:tt, $doc:tt))+) => {
        /// The roles.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub enum Role {
            $(#[doc = $doc] #[serde(rename = $id)] $role,)+
        }

        impl Role {
            /// Every role.
            pub const ALL: [Self; [$($id),+].len()] = [$(Self::$role),+];

            /// The name in files and ids.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$role => $id,)+
                }
            }
        }
    };
}
with_roles!(roles);

macro_rules! slots {
    ($([$slot:ident $field:ident $trait:ident] ($role:ident, $id:tt, $default:tt, $doc:tt))+) => {
        /// The places that plugins fill; a local planner has three.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub enum Slot {
            $(#[doc = concat!("`", $id, "`: ", $doc)] #[serde(rename = $id)] $slot,)+
        }

        impl Slot {
            /// Every slot, in the order of their numbers.
            pub const ALL: [Self; [$($id),+].len()] = [$(Self::$slot),+];

            /// The name in files and on the command line.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$slot => $id,)+
                }
            }

            /// The role that fills the slot.
            pub fn role(self) -> Role {
                match self {
                    $(Self::$slot => Role::$role,)+
                }
            }

            /// The id of the plugin that fills the slot where nothing else is chosen.
            pub fn default_plugin(self) -> &'static str {
                match self {
                    $(Self::$slot => $default,)+
                }
            }
        }
    };
}
with_slots!(slots);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_numbers_belong_together() {
        for (number, slot) in Slot::ALL.into_iter().enumerate() {
            assert_eq!(slot as usize, number);
            let role = slot.role().name();
            assert!(slot.name().starts_with(role), "{slot:?}");
            assert!(slot.default_plugin().strip_prefix(role).is_some_and(|rest| rest.starts_with('/')));
            assert_eq!(serde_json::to_value(slot).unwrap(), slot.name());
        }
        for role in Role::ALL {
            assert!(Slot::ALL.iter().any(|slot| slot.role() == role), "{role:?}");
            assert_eq!(serde_json::to_value(role).unwrap(), role.name());
        }
    }
}
