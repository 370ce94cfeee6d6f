"""The out-of-process coupling: a server process over a loopback connection."""
