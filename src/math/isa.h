#pragma once
// The instruction set this translation unit is compiled for.
//
// The kernels are compiled once per instruction set, and one of them is chosen when the program starts. The
// linker merges equal templates and inline functions of different translation units, so a kernel for AVX-512
// could hand its version of a function to code that must run everywhere. Therefore every function that shades
// or traces stands in an inline namespace named after the instruction set: different names, nothing to merge.
// Plain aggregates (Vec3, Color, the records of the world) stand outside it, so that both sides agree about
// the data.

#ifndef LAMBENT_ISA
#define LAMBENT_ISA baseline
#endif
