#!/bin/sh
# Install a Chromium for the tests of the web page: the distribution's if apt is available, otherwise Playwright's.
set -eu
for name in chromium chromium-browser google-chrome; do
    if command -v "$name" >/dev/null 2>&1; then
        "$name" --version 2>/dev/null || true
        exit 0
    fi
done
if command -v apt-get >/dev/null 2>&1; then
    run=""
    [ "$(id -u)" -eq 0 ] || run="sudo -n"
    $run apt-get update
    $run env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends chromium fonts-dejavu-core
    chromium --version
else
    python -m playwright install --with-deps chromium
fi
