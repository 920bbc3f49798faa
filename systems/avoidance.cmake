# SPDX-License-Identifier: BSD-3-Clause
set(avoidance)
set(avoidance_headers)
set(avoidance_sources)
