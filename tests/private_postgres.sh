#!/bin/bash
# Starts a PostgreSQL server of its own from Debian's package, runs a command with SHEER_TEST_STORE set to the URL of its
# empty database, and removes the server and its folder again:
#
#   tests/private_postgres.sh COMMAND [ARGUMENT...]
#
# Without a command it prints the URL and serves until it is interrupted. The server listens on a socket in its temporary
# folder and on nothing else. As root it runs as the user nobody, since PostgreSQL refuses root. It does not wait for the
# disk, unless SHEER_TEST_DURABLE is set: for measurements.
set -euo pipefail
export LC_ALL=C.UTF-8

fail() {
    echo "private_postgres: $*" >&2
    exit 1
}

programs=$(find /usr/lib/postgresql/*/bin -maxdepth 0 2>/dev/null | sort -V | tail -n 1)
[[ -x ${programs:-}/initdb ]] || fail "there is no PostgreSQL server; install the package postgresql-15"

folder=$(mktemp -d "${TMPDIR:-/tmp}/sheer-postgres-XXXXXX")
server=
stop() {
    trap '' INT TERM HUP
    if [[ $server ]] && kill -INT "$server" 2>/dev/null; then
        # A client that was stopped would keep the server waiting.
        for ((tenths = 0; tenths < 100; ++tenths)); do
            kill -0 "$server" 2>/dev/null || break
            sleep 0.1
        done
        kill -QUIT "$server" 2>/dev/null || true
        wait "$server" 2>/dev/null || true
    fi
    rm -rf "$folder"
}
trap stop EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
trap 'exit 129' HUP

as=()
if [[ $EUID == 0 ]]; then
    as=(setpriv --reuid=nobody --regid=nogroup --clear-groups)
    chown nobody:nogroup "$folder"
fi
# The server ends with this script, even if that is killed.
options=(-c listen_addresses= -c "unix_socket_directories=$folder" -c max_connections=200)
if [[ ! ${SHEER_TEST_DURABLE:-} ]]; then options+=(-c fsync=off -c full_page_writes=off -c synchronous_commit=off); fi
cd "$folder"
"${as[@]}" "$programs/initdb" -D "$folder/data" -U sheer -A trust -E UTF8 --locale=C.UTF-8 -N >"$folder/initdb.log" 2>&1 ||
    fail "initdb failed: $(cat "$folder/initdb.log")"
"${as[@]}" setpriv --pdeathsig=QUIT "$programs/postgres" -D "$folder/data" "${options[@]}" >"$folder/server.log" 2>&1 &
server=$!
for ((tenths = 0; tenths < 300; ++tenths)); do
    if "$programs/pg_isready" -q -h "$folder" -U sheer; then break; fi
    kill -0 "$server" 2>/dev/null || fail "the server did not start: $(cat "$folder/server.log")"
    sleep 0.1
done
cd "$OLDPWD"
export SHEER_TEST_STORE="postgresql://sheer@/postgres?host=$folder"
if [[ $# -gt 0 ]]; then
    # In the background, so that a signal is answered at once.
    "$@" <&0 &
    command=$!
    trap 'kill -INT "$command" 2>/dev/null; wait "$command" || true; exit 130' INT
    trap 'kill -TERM "$command" 2>/dev/null; wait "$command" || true; exit 143' TERM
    code=0
    wait "$command" || code=$?
    exit "$code"
fi
echo "$SHEER_TEST_STORE"
wait "$server"
