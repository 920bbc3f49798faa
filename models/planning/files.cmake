# SPDX-License-Identifier: BSD-3-Clause
list(APPEND headers planning/certified_motion.h planning/clearance.h planning/rrt_connect.h)
list(APPEND sources planning/certified_motion.cc planning/clearance.cc planning/rrt_connect.cc)

# Bands.
list(APPEND headers planning/band_curve.h planning/band_planner.h planning/clairvoyant.h
  planning/elastic_band.h planning/motion_judge.h planning/smooth_step.h)
list(APPEND sources planning/band_curve.cc planning/band_planner.cc planning/clairvoyant.cc
  planning/elastic_band.cc planning/elastic_band_steps.cc
  planning/motion_judge.cc)
