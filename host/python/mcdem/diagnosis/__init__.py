"""From the observations of an experiment and of simulations to a verdict: which neglected effects are consistent with the gap."""
