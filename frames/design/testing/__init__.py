"""Tests of bearings: the programme and the acceptance."""
