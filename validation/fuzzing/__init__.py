"""Random test cases: how they are drawn, run, checked and reported (validation/random_scenes.py)."""
