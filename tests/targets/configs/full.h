/* SPDX-License-Identifier: MIT */
/* Everything, as without a configuration. */
