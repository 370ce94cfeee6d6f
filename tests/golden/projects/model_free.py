"""The same model on base nodes that turn about x and y with their beams."""

import runpy

runpy.run_path("model.py", init_globals={"HELD": 0})
