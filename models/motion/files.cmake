# SPDX-License-Identifier: BSD-3-Clause
list(APPEND headers motion/following.h motion/stoppable_motion.h)
list(APPEND sources motion/following.cc motion/stoppable_motion.cc)
