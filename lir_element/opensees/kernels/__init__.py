"""Compiled kernels of the plug-in: functions that OpenSees calls, and calls to OpenSees."""
