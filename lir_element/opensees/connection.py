"""Adding the host element, an OpenSees `genericClient`, and taking hold of its connection.

The element connects to a port on loopback as soon as it is added. The port is open for that moment
only, and only the connection that this very process made is accepted.
"""

from __future__ import annotations

import os
import socket
from typing import TYPE_CHECKING, Any

from lir_element.opensees.block.protocol import vector_length
from lir_element.opensees.held_signals import calls_uninterrupted

if TYPE_CHECKING:
    from lir_element.opensees.placement import Placement

_LOOPBACK = "127.0.0.1"
_BACKLOG = 16
_WAIT = 5.0
"""How long a connection may take to show up [s]; it is there when the element was added."""


def add_host_element(ops: Any, tag: int, placement: Placement) -> socket.socket:
    """Add a `genericClient` to the current model and return our end of its connection."""
    dofs = [*range(1, placement.dofs // 2 + 1)]
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as listener:
        listener.bind((_LOOPBACK, 0))
        listener.listen(_BACKLOG)
        listener.settimeout(_WAIT)
        port = listener.getsockname()[1]
        with calls_uninterrupted():  # OpenSees gives up a connection that a signal interrupts
            ops.element(
                "genericClient",
                tag,
                "-node",
                *placement.nodes,
                "-dof",
                *dofs,
                "-dof",
                *dofs,
                "-server",
                port,
                _LOOPBACK,
                "-dataSize",
                vector_length(placement.dofs),
                "-noRayleigh",
            )
        try:
            return _accept_own(listener, port, tag)
        except BaseException:
            ops.remove("element", tag)  # before the port closes: its farewell must find an end
            raise


def own_connections() -> list[Any]:
    """Return this process's TCP connections, as psutil does, that have another end."""
    try:
        import psutil
    except ImportError as cause:
        msg = (
            "psutil is not installed, which finds the bearing's connection to OpenSees: "
            'pip install "lir-dcfp[opensees]"'
        )
        raise ImportError(msg) from cause
    return [each for each in psutil.Process(os.getpid()).net_connections("tcp4") if each.raddr]


def _accept_own(listener: socket.socket, port: int, tag: int) -> socket.socket:
    # Take the connection that this process made; whoever else knocked is sent away.
    own = {each.laddr.port for each in own_connections() if each.raddr.port == port}
    while own:
        try:
            connection, (address, peer) = listener.accept()
        except TimeoutError:
            break
        if address == _LOOPBACK and peer in own:
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            connection.setblocking(True)
            return connection
        connection.close()
    msg = (
        f"bearing element {tag}: the connection of its host element did not arrive at "
        f"{_LOOPBACK}:{port}; allow connections on the loopback interface"
    )
    raise ConnectionError(msg)
