// SPDX-License-Identifier: Apache-2.0
/// The mains of the executables, compiled into the tests under these names.
#pragma once

using Main = int (*)(int argc, const char** argv);

int makevismap_main(int argc, const char** argv);
int makecfem_main(int argc, const char** argv);
int makelightmap_main(int argc, const char** argv);
int vmcost_main(int argc, const char** argv);
int vmframes_main(int argc, const char** argv);
int vmexport_main(int argc, const char** argv);
