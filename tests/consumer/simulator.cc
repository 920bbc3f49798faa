// SPDX-License-Identifier: BSD-3-Clause
#include <oca/tools/simulator/simulator_main.h>

#include "catalogue.h"

int main(int argc, char** argv) { return oca::tools::SimulatorMain(argc, argv, acme::Catalogue()); }
