// apps: the threads of the system's BLAS, which sparse normal equations and training ask for
// products.
//
// OpenBLAS starts a thread for every core when it is loaded, and these look for work in a loop for
// 0.1 s before they sleep: a third of what a fit of 32 recordings takes, on a core that another job
// may need. Products that threads share also round otherwise, so that results would depend on how
// many cores a machine has.
#pragma once

namespace pushid {

// Does nothing where the BLAS is another one, or the user has said OPENBLAS_NUM_THREADS.
void SetBlasThreads(int num_threads);

}  // namespace pushid
