# SPDX-License-Identifier: BSD-3-Clause
list(APPEND headers motion/stoppable_motion.h)
list(APPEND sources motion/stoppable_motion.cc)
