# SPDX-License-Identifier: MIT
parts_list() { :; }
parts_run() { :; }
## Claims ##
parts_check() { :; }
