"""A strategy: samples new nodes, and now and then joins two components by a transfer and regrasps."""

import dataclasses

import regrasp as rg


class Alternate(rg.GraphStrategy):
    """Explores and connects at a fixed rate."""

    id = "graph-strategy/template"
    references = (
        "Kavraki, Svestka, Latombe, Overmars, Probabilistic roadmaps for path planning in high-dimensional "
        "configuration spaces, T-RA 1996",
    )

    @dataclasses.dataclass(frozen=True)
    class Settings:
        """Settings of the strategy."""

        connect: float = rg.setting(
            0.3, range=(0.0, 0.9), doc="The part of the steps that connects two components."
        )

    def decide(self, graph: rg.Graph, context: rg.Context) -> rg.Action:
        """Asks as soon as start and goal are joined, stops where the budget is used up."""
        if graph.joined:
            return rg.Action.query()
        generated, most = graph.generated
        if generated >= most:
            return rg.Action.stop()
        connect = context.uniform() < self.settings.connect
        node = context.index(graph.node_count)
        other = nearest_elsewhere(graph, node) if connect else None
        if other is None:
            return rg.Action.explore()
        return rg.Action.connect(node, other, "transfer-regrasp")


def nearest_elsewhere(graph: rg.Graph, node: int) -> int | None:
    """The nearest node of another component with which `node` was not tried yet."""
    own = graph.component(node)
    others = [
        other
        for other in range(graph.node_count)
        if graph.component(other) != own and not graph.attempted(node, other, "transfer-regrasp")
    ]
    return min(others, key=lambda other: graph.distance(node, other), default=None)
