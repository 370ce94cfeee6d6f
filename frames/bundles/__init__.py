"""Bundles of arrays that the time loop works on: the model, the run, nonlinear parts, peaks."""
