"""Walks node trees: what feeds a socket, through reroutes, muted nodes and node groups."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy


@dataclass(frozen=True)
class Feed:
    """What feeds a socket: the output of a node, or without a node the value of `socket`."""

    socket: Any
    node: Any = None
    output: Any = None
    #: The group nodes around, outermost first: the inputs of a group are those of its node.
    groups: tuple = ()

    @property
    def value(self) -> float | tuple[float, ...] | None:
        """The value of the socket where nothing is linked, as floats; `None` for sockets without one."""
        value = getattr(self.socket, "default_value", None)
        if value is None or isinstance(value, (float, int)):
            return value
        return tuple(value)[:3]

    def input(self, key: str | int) -> Feed:
        """What feeds an input of the node."""
        return feed(self.node.inputs[key], self.groups)

    def has_input(self, key: str | int) -> bool:
        return key in self.node.inputs


def feed(socket: bpy.types.NodeSocket, groups: tuple[bpy.types.Node, ...] = ()) -> Feed:
    """What feeds this socket of a node inside of these groups."""
    for _ in range(1000):  # A cycle of nodes has no end.
        link = next((link for link in socket.links if link.is_valid and not link.is_muted), None) if socket.is_linked else None
        if link is None:
            return Feed(socket, groups=groups)
        node, output = link.from_node, link.from_socket
        if node.type == "REROUTE":
            socket = node.inputs[0]
        elif node.mute:
            passed = next((inner.from_socket for inner in node.internal_links if inner.to_socket == output), None)
            if passed is None:
                return Feed(socket, groups=groups)
            socket = passed
        elif node.type == "GROUP" and node.node_tree:
            inside = group_output(node.node_tree)
            inner = by_identifier(inside.inputs, output.identifier) if inside else None
            if inner is None:
                return Feed(socket, groups=groups)
            socket, groups = inner, (*groups, node)
        elif node.type == "GROUP_INPUT" and groups:
            outer = by_identifier(groups[-1].inputs, output.identifier)
            if outer is None:
                return Feed(socket, groups=groups)
            socket, groups = outer, groups[:-1]
        else:
            return Feed(socket, node, output, groups)
    return Feed(socket, groups=groups)


def group_output(tree: bpy.types.NodeTree) -> bpy.types.Node | None:
    """The node at which the results of a group arrive."""
    outputs = [node for node in tree.nodes if node.type == "GROUP_OUTPUT"]
    return next((node for node in outputs if node.is_active_output), outputs[0] if outputs else None)


def by_identifier(sockets: bpy.types.bpy_prop_collection, identifier: str) -> bpy.types.NodeSocket | None:
    return next((socket for socket in sockets if socket.identifier == identifier), None)


def has_nodes(block: bpy.types.Material | bpy.types.World) -> bool:
    """Whether nodes describe a material or a world; since Blender 5 they always do."""
    return block.node_tree is not None and (bpy.app.version >= (5, 0, 0) or block.use_nodes)


def output_of(tree: bpy.types.NodeTree, kind: str, target: str = "CYCLES") -> bpy.types.Node | None:
    """The output node of a tree: the one that Blender marks as active for renderers like this one."""
    found = tree.get_output_node(target) if hasattr(tree, "get_output_node") and kind == "OUTPUT_MATERIAL" else None
    if found:
        return found
    nodes = [node for node in tree.nodes if node.type == kind]
    return next((node for node in nodes if node.is_active_output), nodes[0] if nodes else None)
