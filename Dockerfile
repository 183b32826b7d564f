# The program `pontoon` in a container. Untested where it was written: that machine runs no containers.
FROM rust:1-slim-bookworm AS build
WORKDIR /source
COPY . .
RUN cargo build --release --locked --features surface

FROM debian:bookworm-slim
COPY --from=build /source/target/release/pontoon /usr/local/bin/pontoon
WORKDIR /data
ENTRYPOINT ["pontoon"]
CMD ["--help"]
