"""A plan file as other people's programs see it: a hand in pinocchio, bodies in coal, the meant motion.

Nothing here comes from the project but the plan file: joints are placed by pinocchio, distances are
coal's. SI units; H is the hand's frame, O the object's.
"""

import coal
import numpy as np
import pinocchio as pin


def pose_of(description):
    """The placement that a description means: position, and a quaternion or an axis with an angle."""
    position = np.array(description.get("position", [0.0, 0.0, 0.0]), float)
    turn = np.eye(3)
    if description.get("orientation"):
        w, x, y, z = description["orientation"]
        turn = pin.Quaternion(w, x, y, z).normalized().toRotationMatrix()
    elif description.get("rpy_deg"):
        turn = pin.rpy.rpyToMatrix(*np.radians(description["rpy_deg"]))
    elif description.get("axis"):
        axis = np.array(description["axis"], float)
        turn = pin.exp3(axis / np.linalg.norm(axis) * np.radians(description.get("angle_deg", 0.0)))
    return pin.SE3(turn, position)


def pose_of_state(state):
    """The object's placement in a state."""
    return pose_of(state["object"])


def between(a, b, f):
    """The placement a fraction of the way: position linear, orientation by slerp."""
    turn = a.rotation @ pin.exp3(pin.log3(a.rotation.T @ b.rotation) * f)
    return pin.SE3(turn, a.translation + (b.translation - a.translation) * f)


class Hand:
    """The hand's joints in pinocchio: one chain a finger, joints in the plan's order."""

    def __init__(self, description):
        self.description = description
        self.radius = description["fingertip_radius"]
        self.model = pin.Model()
        self.joints, self.tips, self.fingers = [], [], []
        for finger in description["finger"]:
            parent, base = 0, pose_of(finger.get("base", {}))
            chain = []
            for joint in finger["joint"]:
                axis = np.array(joint["axis"], float)
                axis /= np.linalg.norm(axis)
                sliding = joint.get("kind", "revolute") == "prismatic"
                kind = (
                    pin.JointModelPrismaticUnaligned(axis)
                    if sliding
                    else pin.JointModelRevoluteUnaligned(axis)
                )
                name = f"{finger['name']}/{joint['name']}"
                parent = self.model.addJoint(parent, kind, base * pose_of(joint.get("origin", {})), name)
                base = pin.SE3.Identity()
                chain.append(parent)
                self.joints.append(joint)
            self.fingers.append(chain)
            self.tips.append(np.array(finger.get("tip", [0.0, 0.0, 0.0]), float))
        self.data = self.model.createData()

    def place(self, q):
        """Places all links for joint positions in the plan's order."""
        pin.forwardKinematics(self.model, self.data, np.asarray(q, float))

    def link(self, finger, joint=-1):
        return self.data.oMi[self.fingers[finger][joint]]

    def tip(self, finger):
        """Centre of a fingertip's ball in H (m)."""
        return self.link(finger).act(self.tips[finger])

    def jacobian(self, q, finger, p_H):
        """3 × J Jacobian of a material point of a finger's last link, in H, over all joints of the hand."""
        joint = self.fingers[finger][-1]
        pin.computeJointJacobians(self.model, self.data, np.asarray(q, float))
        J = pin.getJointJacobian(self.model, self.data, joint, pin.LOCAL_WORLD_ALIGNED)
        arm = p_H - self.data.oMi[joint].translation
        return J[:3] - pin.skew(arm) @ J[3:]


def mesh_of(vertices, facets):
    """A mesh in coal, as a tree of its facets."""
    mesh = coal.BVHModelOBBRSS()
    mesh.beginModel(len(facets), len(vertices))
    mesh.addVertices(np.asarray(vertices, float))
    mesh.addTriangles(np.asarray(facets, np.uint32).astype(np.int64))
    mesh.endModel()
    return mesh


def shape_of(shape):
    """A shape in coal, with its placement in the frame of what it belongs to."""
    kind = shape["kind"]
    if kind == "sphere":
        return coal.Sphere(shape["radius"]), pin.SE3.Identity()
    if kind == "capsule":
        a, b = np.array(shape["from"]), np.array(shape["to"])
        along = b - a
        length = np.linalg.norm(along)
        turn = (
            pin.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), along / length)
            if length
            else pin.Quaternion(1, 0, 0, 0)
        )
        return coal.Capsule(shape["radius"], length), pin.SE3(turn.toRotationMatrix(), (a + b) / 2)
    if kind in ("box", "cuboid"):
        return coal.Box(*shape["size"]), pin.SE3.Identity()
    if kind == "cylinder":
        return coal.Cylinder(shape["radius"], shape["height"]), pin.SE3.Identity()
    if kind == "half-space":
        normal = np.array(shape["normal"], float)
        return coal.Halfspace(normal / np.linalg.norm(normal), shape["offset"]), pin.SE3.Identity()
    return mesh_of(shape["vertices"], shape["facets"]), pin.SE3.Identity()


def facets_of(plan):
    """The facets on which the contacts live: those of the plan's own record, or the mesh of its scenario."""
    record = plan.get("object") or {}
    shape = plan["scenario"]["problem"]["object"]["shape"]
    surface = record.get("contact_surface") or record.get("surface")
    if surface is None and shape["kind"] == "mesh":
        surface = shape
    if surface is None:
        raise ValueError("the plan holds no facets of its object")
    return np.array(surface["vertices"], float), np.array(surface["facets"], int)


def true_facets_of(plan):
    """The facets of the object itself, which mass and clearance belong to."""
    shape = plan["scenario"]["problem"]["object"]["shape"]
    if shape["kind"] != "mesh":
        return facets_of(plan)
    return np.array(shape["vertices"], float), np.array(shape["facets"], int)


def off_the_true_shape(shape, vertices):
    """How far vertices are from a primitive's closed form (m, to first order); None for a mesh."""
    x, y, z = vertices.T
    if shape["kind"] == "sphere":
        return np.abs(np.linalg.norm(vertices, axis=1) - shape["radius"])
    if shape["kind"] == "ellipsoid":
        a = np.array(shape["semi_axes"])
        return np.abs(np.linalg.norm(vertices / a, axis=1) - 1) * a.max()
    if shape["kind"] == "cuboid":
        return np.abs(np.abs(vertices / (np.array(shape["size"]) / 2)) - 1).min(axis=1) * max(shape["size"])
    if shape["kind"] == "torus":
        ring = np.hypot(np.hypot(x, y) - shape["ring_radius"], z)
        return np.abs(ring - shape["tube_radius"])
    if shape["kind"] == "cylinder":
        side = np.abs(np.hypot(x, y) - shape["radius"])
        return np.minimum(side, np.abs(np.abs(z) - shape["height"] / 2))
    if shape["kind"] == "capsule":
        beyond = np.maximum(np.abs(z) - shape["height"] / 2, 0.0)
        return np.abs(np.hypot(np.hypot(x, y), beyond) - shape["radius"])
    return None


class Bodies:
    """All bodies of a problem and the pairs of them that may not touch."""

    def __init__(self, plan, hand):
        self.hand = hand
        problem = plan["scenario"]["problem"]
        vertices, facets = facets_of(plan)
        self.surface = mesh_of(vertices, facets)
        self.object = mesh_of(*true_facets_of(plan))
        self.bodies = [("object", self.object, pin.SE3.Identity(), None)]
        for placed in problem["hand"].get("palm", []):
            self.add("palm", placed, None)
        for placed in problem.get("obstacle", []):
            self.add("obstacle", placed, None)
        for f, finger in enumerate(problem["hand"]["finger"]):
            for j, joint in enumerate(finger["joint"]):
                for placed in joint.get("link", []):
                    self.add(("link", f, j), placed, (f, j))
            tip = pin.SE3(np.eye(3), hand.tips[f])
            self.bodies.append((("tip", f), coal.Sphere(hand.radius), tip, (f, len(finger["joint"]) - 1)))
        self.pairs = self.pair_up(problem)

    def add(self, name, placed, link):
        shape, inner = shape_of(placed["shape"])
        self.bodies.append((name, shape, pose_of(placed.get("pose", {})) * inner, link))

    def rank(self, name, hand):
        """How many links with a shape lie before this one on its finger."""
        if name[0] == "link":
            return sum(bool(joint.get("link")) for joint in hand["finger"][name[1]]["joint"][: name[2]])
        return sum(bool(joint.get("link")) for joint in hand["finger"][name[1]]["joint"])

    def pair_up(self, problem):
        hand, limits = problem["hand"], problem["limits"]
        self.hand.place(np.concatenate([finger["rest"] for finger in hand["finger"]]))
        close = limits["tolerances"]["clearance"] + limits["resolution"]["clearance"]
        names = {
            joint["name"]: ("link", f, j)
            for f, finger in enumerate(hand["finger"])
            for j, joint in enumerate(finger["joint"])
        }
        names |= {finger["name"]: ("tip", f) for f, finger in enumerate(hand["finger"])} | {"palm": "palm"}
        touching = [{names[a], names[b]} for a, b in hand.get("touching", [])]
        mounted = set()
        for a, (name, *_) in enumerate(self.bodies):
            for b, (other, *_) in enumerate(self.bodies):
                first = name == "palm" and other[0] == "link" and self.rank(other, hand) == 0
                if first and self.distance(a, b, pin.SE3.Identity()) <= close:
                    mounted.add(other)
        pairs = []
        for a in range(len(self.bodies)):
            for b in range(a + 1, len(self.bodies)):
                n, m = self.bodies[a][0], self.bodies[b][0]
                fixed = [name in ("palm", "obstacle") for name in (n, m)]
                jointed = [isinstance(name, tuple) for name in (n, m)]
                if all(fixed) or n == m or {n, m} in touching or (n == "palm" and m in mounted):
                    continue
                if all(jointed) and n[1] == m[1] and abs(self.rank(n, hand) - self.rank(m, hand)) <= 1:
                    continue
                pairs.append((a, b))
        return pairs

    def placement(self, body, X_HO):
        name, _, inner, link = self.bodies[body]
        if link is not None:
            return self.hand.link(*link) * inner
        return X_HO * inner if name == "object" else inner

    def distance(self, a, b, X_HO):
        """Distance of two bodies (m), with the hand placed as it is."""
        result = coal.DistanceResult()
        place = [
            coal.Transform3s(X.rotation, X.translation)
            for X in (self.placement(a, X_HO), self.placement(b, X_HO))
        ]
        request = coal.DistanceRequest()
        return coal.distance(self.bodies[a][1], place[0], self.bodies[b][1], place[1], request, result)

    def touch(self, finger, X_HO, surface=None):
        """Closest point of what contacts live on, or of another surface, to a tip's centre, direction from
        there, and gap, in O."""
        c = X_HO.actInv(self.hand.tip(finger))
        result = coal.DistanceResult()
        request = coal.DistanceRequest()
        at = coal.Transform3s(np.eye(3), c)
        coal.distance(surface or self.surface, coal.Transform3s(), coal.Sphere(1e-9), at, request, result)
        p = np.array(result.getNearestPoint1())
        away = c - p
        far = np.linalg.norm(away)
        return p, away / max(far, 1e-12), far - self.hand.radius, c
