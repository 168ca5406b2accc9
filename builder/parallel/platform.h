// What a compiler calls device code. Only builder/parallel asks which compiler this is.
#pragma once

#if defined(__CUDACC__)
#define HD __host__ __device__
#else
#define HD
#endif
