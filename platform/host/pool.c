/* SPDX-License-Identifier: MIT */
#include "pool.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <unistd.h>

struct worker {
    struct pool *pool;
    unsigned number;
    pthread_t thread;
};

struct pool {
    pthread_mutex_t lock;
    pthread_cond_t start, end;
    unsigned job;  /* counts them; a change starts the workers */
    unsigned busy; /* workers that are not done with it */
    bool stop;
    pool_task *task;
    void *arg;
    unsigned count;
    atomic_uint next;
    unsigned workers; /* without the caller */
    struct worker worker[POOL_MAX];
};

static void run_tasks(struct pool *pool, unsigned worker)
{
    unsigned task;
    while ((task = atomic_fetch_add(&pool->next, 1)) < pool->count)
        pool->task(pool->arg, task, worker);
}

static void *work(void *arg)
{
    struct worker *me = arg;
    struct pool *pool = me->pool;
    unsigned job = 0;
    pthread_mutex_lock(&pool->lock);
    for (;;) {
        while (pool->job == job && !pool->stop)
            pthread_cond_wait(&pool->start, &pool->lock);
        if (pool->stop)
            break;
        job = pool->job;
        pthread_mutex_unlock(&pool->lock);
        run_tasks(pool, me->number);
        pthread_mutex_lock(&pool->lock);
        if (--pool->busy == 0)
            pthread_cond_signal(&pool->end);
    }
    pthread_mutex_unlock(&pool->lock);
    return NULL;
}

int pool_processors(void)
{
    long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n < 1 ? 1 : n > POOL_MAX ? POOL_MAX : (int)n;
}

struct pool *pool_new(int threads)
{
    struct pool *pool = calloc(1, sizeof *pool);
    if (pool == NULL)
        return NULL;
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->start, NULL);
    pthread_cond_init(&pool->end, NULL);
    atomic_init(&pool->next, 0);
    for (int i = 0; i < threads - 1 && i < POOL_MAX - 1; i++) {
        struct worker *w = &pool->worker[i];
        w->pool = pool;
        w->number = (unsigned)i + 1;
        if (pthread_create(&w->thread, NULL, work, w) != 0)
            break;
        pool->workers++;
    }
    return pool;
}

void pool_free(struct pool *pool)
{
    if (pool == NULL)
        return;
    pthread_mutex_lock(&pool->lock);
    pool->stop = true;
    pthread_cond_broadcast(&pool->start);
    pthread_mutex_unlock(&pool->lock);
    for (unsigned i = 0; i < pool->workers; i++)
        pthread_join(pool->worker[i].thread, NULL);
    pthread_cond_destroy(&pool->start);
    pthread_cond_destroy(&pool->end);
    pthread_mutex_destroy(&pool->lock);
    free(pool);
}

unsigned pool_threads(const struct pool *pool)
{
    return pool == NULL ? 1 : pool->workers + 1;
}

void pool_run(struct pool *pool, pool_task *task, void *arg, unsigned count)
{
    if (pool == NULL || pool->workers == 0 || count < 2) {
        for (unsigned i = 0; i < count; i++)
            task(arg, i, 0);
        return;
    }
    pthread_mutex_lock(&pool->lock);
    pool->task = task;
    pool->arg = arg;
    pool->count = count;
    atomic_store(&pool->next, 0);
    pool->busy = pool->workers;
    pool->job++;
    pthread_cond_broadcast(&pool->start);
    pthread_mutex_unlock(&pool->lock);
    run_tasks(pool, 0);
    pthread_mutex_lock(&pool->lock);
    while (pool->busy > 0)
        pthread_cond_wait(&pool->end, &pool->lock);
    pthread_mutex_unlock(&pool->lock);
}
