"""The portable route: a server process over a loopback connection."""
