/* SPDX-License-Identifier: MIT */
/*
 * Threads that wait for work. A job is a number of tasks; each is taken from
 * a counter by whichever thread is free, the caller's among them.
 */
#ifndef BRUME_HOST_POOL_H
#define BRUME_HOST_POOL_H

#define POOL_MAX 256 /* threads */

struct pool;

/* Task number `task` of a job, on thread `worker` (0 is the caller). */
typedef void pool_task(void *arg, unsigned task, unsigned worker);

/* Processors that are online, 1 .. POOL_MAX. */
int pool_processors(void);

/* `threads` of them with the caller's; those that cannot be made are done
 * without. NULL without memory. */
struct pool *pool_new(int threads);
void pool_free(struct pool *pool);

/* The caller's and those made. 1 for NULL. */
unsigned pool_threads(const struct pool *pool);

/* Runs tasks 0 .. count - 1 and returns when all are done. A pool that is NULL
 * has the caller's thread only. From one thread at a time; not from a task. */
void pool_run(struct pool *pool, pool_task *task, void *arg, unsigned count);

#endif
