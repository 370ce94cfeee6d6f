"""The testing rig."""
